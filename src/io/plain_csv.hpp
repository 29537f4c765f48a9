// The CSV sink itself, without what watches over its numbers (results.cpp).
#pragma once
#include <io/results.hpp>

namespace whirl::io {

TimeSeriesPtr make_plain_csv_series(std::filesystem::path file, SeriesOptions options);

}  // namespace whirl::io
