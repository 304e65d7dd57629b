// Matrices from files of others and back, and the messages about damaged ones.

#include "mcdbn/base/matrix_file.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <limits>

#include "base/npy.hpp"
#include "base/random_matrix.hpp"
#include "base/safetensors.hpp"
#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Numbers as a file holds them.
template <typename Stored>
std::string bytes_of(std::initializer_list<Stored> values) {
  std::string bytes(values.size() * sizeof(Stored), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

std::string npy_of(const std::string& header, const std::string& data, int version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  const auto length = static_cast<std::uint32_t>(header.size());
  bytes.append(reinterpret_cast<const char*>(&length), version == 1 ? 2 : 4);
  return bytes + header + data;
}

std::string header_of(const std::string& type, const std::string& shape, bool by_columns = false) {
  return fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}\n", type,
                     by_columns ? "True" : "False", shape);
}

/// The message of reading the file; empty if it is read.
std::string complaint(const std::filesystem::path& path, const std::string& tensor = "") {
  try {
    read_matrix(path, tensor);
  } catch (const InputError& error) {
    const std::string text = error.what();
    CHECK(text.starts_with(path.string()));
    return text.substr(path.string().size());
  }
  return "";
}

bool same_bits(const MatrixF& x, const MatrixF& y) {
  return x.rows() == y.rows() && x.cols() == y.cols() &&
         std::memcmp(x.data(), y.data(), static_cast<std::size_t>(x.size()) * sizeof(float)) == 0;
}

MatrixF rows_of(std::initializer_list<std::initializer_list<float>> rows) {
  MatrixF values(rows.size(), rows.begin()->size());
  Eigen::Index r = 0;
  for (const auto& row : rows) {
    Eigen::Index c = 0;
    for (const float x : row) values(r, c++) = x;
    ++r;
  }
  return values;
}

}  // namespace

TEST_CASE("matrices come back from every kind of file, bit for bit") {
  const ScratchFolder folder;
  using Limits = std::numeric_limits<float>;
  MatrixF values = random_matrix(7, 5, 1);
  values(0, 0) = Limits::denorm_min();
  values(1, 2) = -1.0F / 3.0F;
  values(2, 4) = Limits::max();
  values(3, 3) = -0.0F;
  values(4, 0) = Limits::quiet_NaN();
  values(5, 1) = 16777217.0F;
  for (const char* name : {"x.npy", "x.csv", "x.safetensors", "X.NPY"}) {
    CAPTURE(name);
    CHECK(is_matrix_file(name));
    write_matrix(folder / name, values);
    CHECK(same_bits(read_matrix(folder / name), values));
    write_matrix(folder / name, values.topLeftCorner(1, 1));
    CHECK(same_bits(read_matrix(folder / name), values.topLeftCorner(1, 1)));
  }
  CHECK_FALSE(is_matrix_file("x.txt"));
  CHECK(complaint(folder / "x.txt").find("unknown kind of file") != std::string::npos);
  CHECK_THROWS_AS(write_matrix(folder / "x.txt", values), InputError);
}

TEST_CASE("matrices without a row are refused in every kind of file") {
  const ScratchFolder folder;
  for (const char* name : {"x.npy", "x.csv", "x.safetensors"}) {
    CAPTURE(name);
    write_matrix(folder / name, MatrixF(0, 4));
    CHECK(complaint(folder / name) == ": no numbers");
  }
  CHECK(complaint(folder.write("flat.npy", npy_of(header_of("<f4", "(0,)"), ""))) ==
        ": no numbers");
}

TEST_CASE("npy: every type of number, both orders, all versions") {
  const MatrixF want = rows_of({{1, 2, 3}, {4, 5, 6}});
  const auto check = [&](const std::string& type, const std::string& data,
                         const std::string& by_columns) {
    CAPTURE(type);
    for (const int version : {1, 2, 3}) {
      CHECK(npy_matrix(npy_of(header_of(type, "(2, 3)"), data, version)) == want);
      CHECK(npy_matrix(npy_of(header_of(type, "(2, 3)", true), by_columns, version)) == want);
    }
  };
#define CHECK_TYPE(name, Stored) \
  check(name, bytes_of<Stored>({1, 2, 3, 4, 5, 6}), bytes_of<Stored>({1, 4, 2, 5, 3, 6}))
  CHECK_TYPE("<f4", float);
  CHECK_TYPE("<f8", double);
  CHECK_TYPE("|i1", std::int8_t);
  CHECK_TYPE("|u1", std::uint8_t);
  CHECK_TYPE("<i2", std::int16_t);
  CHECK_TYPE("<u2", std::uint16_t);
  CHECK_TYPE("<i4", std::int32_t);
  CHECK_TYPE("<u4", std::uint32_t);
  CHECK_TYPE("<i8", std::int64_t);
  CHECK_TYPE("<u8", std::uint64_t);
  CHECK(npy_matrix(npy_of(header_of("|b1", "(3,)"), bytes_of<char>({1, 0, 1}))) ==
        rows_of({{1}, {0}, {1}}));
  CHECK(npy_matrix(npy_of(header_of("<i2", "(1, 2)"), bytes_of<std::int16_t>({-3, 300}))) ==
        rows_of({{-3, 300}}));
  CHECK(npy_matrix(npy_of(header_of("|i1", "(1, 1)"), "\xff")) == rows_of({{-1}}));
  CHECK(npy_matrix(npy_of(header_of("|u1", "(1, 1)"), "\xff")) == rows_of({{255}}));
}

TEST_CASE("npy: what is written is laid out as the format specifies") {
  const std::string bytes = npy_bytes(random_matrix(3, 2, 1));
  std::uint16_t length = 0;
  std::memcpy(&length, bytes.data() + 8, 2);
  CHECK(bytes.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8));
  CHECK((10 + length) % 64 == 0);
  CHECK(bytes[9 + length] == '\n');
  CHECK(bytes.size() == 10U + length + 6 * sizeof(float));
}

TEST_CASE("npy: damaged files are refused, and the message names what is wrong") {
  const ScratchFolder folder;
  const std::string six = bytes_of<float>({1, 2, 3, 4, 5, 6});
  const auto check_refused = [&](const std::string& bytes, const std::string& words) {
    const auto path = folder.write("x.npy", bytes);
    CAPTURE(words);
    const std::string text = complaint(path);
    CAPTURE(text);
    CHECK(text.starts_with(": not a readable .npy file: "));
    CHECK(text.find(words) != std::string::npos);
  };
  check_refused("", "does not begin");
  check_refused("hello", "does not begin");
  check_refused("\x93NUMPY", "shorter than its header");
  check_refused(npy_of("{}", six), "no 'descr'");
  check_refused(npy_of(header_of("<f4", "(2, 3)"), six, 4), "version 4");
  check_refused(npy_of(header_of("<f4", "(2, 3)"), six).substr(0, 40), "shorter than its header");
  check_refused(npy_of(header_of("<f4", "(2, 4)"), six), "24 bytes of numbers, not 2 x 4");
  check_refused(npy_of(header_of("<f4", "(2, 2)"), six), "not 2 x 2");
  check_refused(npy_of(header_of("<f4", "(0, 3)"), six), "not 0 x 3");
  check_refused(npy_of(header_of("<f4", "(2, 3)"), six.substr(1)), "23 bytes");
  check_refused(npy_of(header_of("<f4", "(4611686018427387904, 4)"), ""), "0 bytes of numbers");
  check_refused(npy_of(header_of("<f4", "(4611686018427387904, 0)"), ""),
                "4611686018427387904 rows without columns");
  check_refused(npy_of(header_of("<f4", "(1, 2, 3)"), six), "3 dimensions");
  check_refused(npy_of(header_of("<f4", "()"), six.substr(0, 4)), "0 dimensions");
  check_refused(npy_of(header_of(">f4", "(2, 3)"), six), "type '>f4'");
  check_refused(npy_of(header_of("<f2", "(2, 3)"), six), "type '<f2'");
  check_refused(npy_of(header_of("|O", "(2, 3)"), six), "type '|O'");
  check_refused(npy_of(header_of("<f4", "(-2, 3)"), six), "'shape' is not of whole numbers");
  check_refused(npy_of(header_of("<f4", "2"), six), "'shape' is no tuple");
  check_refused(npy_of("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (2, 3), }", six),
                "records are not read");
  check_refused(npy_of("{'descr': '<f4', 'fortran_order': 0, 'shape': (2, 3), }", six),
                "neither True nor False");
  check_refused(npy_of("{'descr': '<f4', 'fortran_order': ", six), "neither True nor False");
}

TEST_CASE("csv: with and without a header, empty cells, spaces and line ends of others") {
  const ScratchFolder folder;
  const auto read = [&](const std::string& text) {
    return read_matrix(folder.write("x.csv", text));
  };
  const MatrixF want = rows_of({{1, -2.5F}, {3e-2F, 4}});
  CHECK(read("1,-2.5\n3e-2,4\n") == want);
  CHECK(read("1,-2.5\n3e-2,4") == want);
  CHECK(read("a,b\n1,-2.5\n3e-2,4\n") == want);
  CHECK(read("\xEF\xBB\xBF\"x y\",z\r\n +1 ,\t-2.5\r\n\r\n0.03,4\r\n\r\n") == want);
  CHECK(read("a,b,c\n1,-2.5\n0.03,4\n") == want);  // a header may have more names than columns
  const MatrixF holes = read("1,,3\nnan,NaN,\n");
  CHECK(holes.array().isNaN().count() == 4);
  CHECK(holes(0, 2) == 3);
  CHECK(read("7\n8\n") == rows_of({{7}, {8}}));
  CHECK(read("1e-50,inf\n")(0, 0) == 0.0F);
}

TEST_CASE("csv: of one column an empty line is an unknown number, but for the last") {
  const ScratchFolder folder;
  // NaN as -1, which is not in the files.
  const auto read = [&](const std::string& text) {
    const MatrixF values = read_matrix(folder.write("x.csv", text));
    CHECK(values.cols() == 1);
    return MatrixF(values.array().isNaN().select(-1.0F, values));
  };
  CHECK(read("1\n\n3\n") == rows_of({{1}, {-1}, {3}}));
  CHECK(read("1\n\n3\n\n") == rows_of({{1}, {-1}, {3}}));
  CHECK(read("1\n\n\n") == rows_of({{1}, {-1}}));
  CHECK(read("x\r\n\r\n2\r\n\"\"\r\n4") == rows_of({{-1}, {2}, {-1}, {4}}));
  CHECK(read("\n\nx\n2\n") == rows_of({{2}}));
  // What pandas and R write of several columns has a comma in every line.
  CHECK(read_matrix(folder.write("x.csv", "1,2\n\n3,4\n\n\n")) == rows_of({{1, 2}, {3, 4}}));
}

TEST_CASE("csv: damaged files are refused by file and line") {
  const ScratchFolder folder;
  const auto check_refused = [&](const std::string& text, const std::string& words) {
    CAPTURE(text);
    CHECK(complaint(folder.write("x.csv", text)) == words);
  };
  check_refused("", ": no numbers");
  check_refused("a,b\n", ": no numbers");
  check_refused("1,2\n3\n", ":2: 1 columns, 2 in the lines before it");
  check_refused("a,b\n\n1,2\n3,4,5\n", ":4: 3 columns, 2 in the lines before it");
  check_refused("1,2\n3,x\n", ":2: 'x' in column 2 is no number");
  check_refused("a,b\nc,d\n", ":2: 'c' in column 1 is no number");
  // Each would lose its first row if it were taken for a header.
  check_refused("n/a,2,3\n4,5,6\n", ":1: 'n/a' in column 1 is no number");
  check_refused("1,2,NA\n4,5,6\n", ":1: 'NA' in column 3 is no number");
  check_refused("1,2\n1;2\n", ":2: '1;2' in column 1 is no number");
  check_refused("1,2\n3,4x\n", ":2: '4x' in column 2 is no number");
  CHECK(complaint(folder / "absent.csv").find("cannot be opened") != std::string::npos);
}

TEST_CASE("safetensors: the only tensor, or the one of a name") {
  const ScratchFolder folder;
  Safetensors content;
  const MatrixF one = random_matrix(3, 2, 1), two = random_matrix(2, 4, 2);
  content.put("one", one);
  write_safetensors(folder / "x.safetensors", content);
  CHECK(read_matrix(folder / "x.safetensors") == one);
  CHECK(read_matrix(folder / "x.safetensors", "one") == one);
  CHECK(complaint(folder / "x.safetensors", "two") == ": no tensor two");
  content.put("two", two);
  content.tensors["flat"] = {{3}, {1, 2, 3}};
  content.tensors["cube"] = {{1, 1, 1}, {1}};
  content.tensors["bare"] = {{9007199254740992, 0}, {}};
  write_safetensors(folder / "x.safetensors", content);
  CHECK(read_matrix(folder / "x.safetensors", "two") == two);
  CHECK(read_matrix(folder / "x.safetensors", "flat") == rows_of({{1}, {2}, {3}}));
  CHECK(complaint(folder / "x.safetensors") == ": 5 tensors; give the name of one");
  CHECK(complaint(folder / "x.safetensors", "cube") ==
        ": tensor cube has 3 dimensions; 2 are wanted");
  CHECK(complaint(folder / "x.safetensors", "bare") ==
        ": tensor bare has 9007199254740992 rows without columns");
  folder.write("y.safetensors", "hello");
  CHECK(complaint(folder / "y.safetensors").find("not a readable") != std::string::npos);
}
