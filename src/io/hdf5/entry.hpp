// Entry points of the HDF5 plug-in.
#pragma once
#include <io/results.hpp>

namespace whirl::io {

using Hdf5MakeSeries = TimeSeries*(const std::filesystem::path&, const SeriesOptions&);
using Hdf5Read = void(const std::filesystem::path&, Columns&);
inline constexpr const char* hdf5_make_series = "whirl_hdf5_make_series";
inline constexpr const char* hdf5_read = "whirl_hdf5_read";

}  // namespace whirl::io
