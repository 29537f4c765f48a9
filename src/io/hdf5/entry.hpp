// Entry points of the HDF5 plug-in.
#pragma once
#include <io/polydata.hpp>
#include <io/results.hpp>
#include <io/words.hpp>

namespace whirl::io {

using Hdf5MakeSeries = TimeSeries*(const std::filesystem::path&, const SeriesOptions&);
/// earlier: of save(), to go on with the file as it is packed; null: a new one.
using Hdf5MakePolyData = PolyDataSeries*(const std::filesystem::path&, bool packed,
                                         InArchive* earlier);
using Hdf5Read = void(const std::filesystem::path&, Columns&);
using Hdf5AddWords = void(const std::filesystem::path&, const std::vector<WordColumn>&);
inline constexpr const char* hdf5_make_series = "whirl_hdf5_make_series";
inline constexpr const char* hdf5_make_polydata = "whirl_hdf5_make_polydata";
inline constexpr const char* hdf5_read = "whirl_hdf5_read";
inline constexpr const char* hdf5_add_words = "whirl_hdf5_add_words";

}  // namespace whirl::io
