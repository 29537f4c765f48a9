#include <assembly/table_spacing.hpp>

#include <core/contract.hpp>
#include <elements/supports/table_bearing.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {
namespace {

using Table = elements::CoefficientTable<6>;
using Values = Table::Values;

/// Largest share by which a matrix misses another, against the largest entry of its kind: forces and
/// moments by displacements and rotations have units of their own.
double missed_share(const Matrix<6>& is, const Matrix<6>& found) {
  const double force = is.topLeftCorner<3, 3>().cwiseAbs().maxCoeff();
  const double moment = is.bottomRightCorner<3, 3>().cwiseAbs().maxCoeff();
  double out = 0;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) {
      const double kind = std::sqrt((i < 3 ? force : moment) * (k < 3 ? force : moment));
      if (kind > 0) out = std::max(out, std::abs(found(i, k) - is(i, k)) / kind);
    }
  return out;
}

/// Rows along one line of a table, by their places.
struct Line {
  std::vector<double> place;
  std::vector<Values> row;
};

/// By how much row i is missed when it is left out: two rows on each side are all that a cubic
/// between them knows of.
double missed_by(const Line& line, std::size_t i, Table::Between between) {
  const std::size_t first = i < 2 ? 0 : i - 2, last = std::min(i + 2, line.place.size() - 1);
  Line beside;
  for (std::size_t k = first; k <= last; ++k) {
    if (k == i) continue;
    beside.place.push_back(line.place[k]);
    beside.row.push_back(line.row[k]);
  }
  const Table table(beside.place, beside.row, between, Table::Outside::hold);
  Values found, rate;
  table.at(line.place[i], found, rate);
  const Values& is = line.row[i];
  return std::max(
      {missed_share(is.K, found.K), missed_share(is.C, found.C), missed_share(is.M, found.M)});
}

}  // namespace

CoarsestRow coarsest_row(const model::TableBearing& table, double low, double high) {
  const std::size_t frequencies = std::max<std::size_t>(table.frequency.size(), 1);
  WHIRL_EXPECTS(table.K.size() == table.speed.size() * frequencies);
  const auto between =
      table.monotone_cubic ? Table::Between::monotone_cubic : Table::Between::linear;
  const auto values = [&](std::size_t k) {
    const Matrix<6> none = Matrix<6>::Zero();
    return Values{table.K[k], k < table.C.size() ? table.C[k] : none,
                  k < table.M.size() ? table.M[k] : none};
  };
  const bool at_a_row =
      low == high && std::find(table.speed.begin(), table.speed.end(), low) != table.speed.end();
  CoarsestRow out;
  const auto look = [&](const Line& line, bool against_frequency) {
    for (std::size_t i = 1; i + 1 < line.place.size(); ++i) {
      const bool used = line.place[i + 1] > low && line.place[i - 1] < high && !at_a_row;
      if (!against_frequency && !used) continue;
      const double error = missed_by(line, i, between) / 4.0;
      if (error > out.error) out = {error, line.place[i], against_frequency};
    }
  };
  for (std::size_t j = 0; j < frequencies; ++j) {
    Line line{table.speed, {}};
    for (std::size_t i = 0; i < table.speed.size(); ++i)
      line.row.push_back(values(i * frequencies + j));
    look(line, false);
  }
  for (std::size_t i = 0; i < table.speed.size() && !table.frequency.empty(); ++i) {
    if (i > 0 && table.speed[i - 1] >= high) continue;
    if (i + 1 < table.speed.size() && table.speed[i + 1] <= low) continue;
    Line line{table.frequency, {}};
    for (std::size_t j = 0; j < frequencies; ++j)
      line.row.push_back(values(i * frequencies + j));
    look(line, true);
  }
  return out;
}

}  // namespace whirl::assembly
