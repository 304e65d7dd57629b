#include "formats/assignment.hpp"

#include <limits>

#include "base/interruption.hpp"

namespace mcdbn {
namespace {

/// For no more rows than columns. Rows and columns count from 1; 0 is the one that is not there.
std::vector<int> assign_rows(const MatrixD& costs) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto rows = static_cast<int>(costs.rows()), columns = static_cast<int>(costs.cols());
  std::vector<double> row_potential(rows + 1), column_potential(columns + 1);
  std::vector<int> row_of(columns + 1), before(columns + 1);
  for (int row = 1; row <= rows; ++row) {
    check_interruption();
    std::vector<double> slack(columns + 1, kInfinity);
    std::vector<bool> visited(columns + 1, false);
    row_of[0] = row;
    int column = 0;
    do {  // the shortest path from the row to a column that is free
      visited[column] = true;
      const int at = row_of[column];
      double least = kInfinity;
      int next = 0;
      for (int j = 1; j <= columns; ++j) {
        if (visited[j]) continue;
        const double reduced = costs(at - 1, j - 1) - row_potential[at] - column_potential[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          before[j] = column;
        }
        if (slack[j] < least) {
          least = slack[j];
          next = j;
        }
      }
      for (int j = 0; j <= columns; ++j) {
        if (visited[j]) {
          row_potential[row_of[j]] += least;
          column_potential[j] -= least;
        } else {
          slack[j] -= least;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    for (; column != 0; column = before[column]) row_of[column] = row_of[before[column]];
  }
  std::vector<int> column_of(rows, -1);
  for (int j = 1; j <= columns; ++j)
    if (row_of[j] != 0) column_of[row_of[j] - 1] = j - 1;
  return column_of;
}

}  // namespace

std::vector<int> cheapest_assignment(const MatrixD& costs) {
  if (costs.rows() <= costs.cols()) return assign_rows(costs);
  const MatrixD turned = costs.transpose();
  const std::vector<int> row_of = assign_rows(turned);
  std::vector<int> column_of(static_cast<std::size_t>(costs.rows()), -1);
  for (std::size_t column = 0; column < row_of.size(); ++column)
    column_of[row_of[column]] = static_cast<int>(column);
  return column_of;
}

}  // namespace mcdbn
