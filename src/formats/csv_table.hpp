#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mcdbn {

/// The lines of a CSV that are neither empty nor comments (#), between commas, semicolons or tabs,
/// as the first line has them; quotes around cells are taken off.
class CsvTable {
 public:
  struct Line {
    int number;  ///< in the file, from 1 on
    std::vector<std::string_view> cells;
  };

  /// @param text is looked at as long as the table lives  @param most lines to read
  CsvTable(std::string_view text, std::string file, std::size_t most = ~std::size_t{0});

  const std::vector<Line>& lines() const { return lines_; }
  /// The first line. @throws InputError if there is none
  const Line& header() const;

  /// The number in a cell; NaN where it is empty, or the line ends before it. @throws InputError
  /// `file:line: what`
  double number_in(const Line& line, std::size_t column) const;
  /// The same, but 1 where there is no column or the cell is empty: what was seen without a
  /// confidence was seen.
  double confidence_in(const Line& line, std::optional<std::size_t> column) const;
  /// @throws InputError if the line has another number of cells
  void require_cells(const Line& line, std::size_t cells) const;
  [[noreturn]] void fail(const Line& line, const std::string& what) const;

 private:
  std::string file_;
  std::vector<Line> lines_;
};

/// In lower case.
std::string lower(std::string_view text);
/// In lower case without separators.
std::string plain(std::string_view name);

/// The index of a name, which is added if it is new.
std::size_t index_of(std::vector<std::string>& names, std::string_view name);

}  // namespace mcdbn
