// The file format of tensors, byte by byte, and what is made of damaged files.

#include "base/safetensors.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/capture_bound.hpp"
#include "base/random_matrix.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace {

/// Eight bytes of length, the header, then the numbers.
std::string file_of(const std::string& header, const std::string& data) {
  const std::uint64_t length = header.size();
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &length, 8);
  return bytes + header + data;
}

std::string bytes_of(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

json header_of(const std::string& bytes) {
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), 8);
  return json::parse(bytes.substr(8, length));
}

Safetensors example() {
  Safetensors content;
  content.put("b", random_matrix(3, 2, 1));
  content.put("a", random_matrix(1, 5, 2));
  content.put("empty", MatrixF(0, 4));
  content.metadata = {{"one", "first \"line\"\nsecond"}, {"two", "ü"}};
  return content;
}

std::size_t files_in(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

void check_same(const Safetensors& got, const Safetensors& want) {
  CHECK(got.metadata == want.metadata);
  REQUIRE(got.tensors.size() == want.tensors.size());
  for (const auto& [name, tensor] : want.tensors) {
    CAPTURE_BOUND(name);
    REQUIRE(got.tensors.count(name) == 1);
    CHECK(got.tensors.at(name).shape == tensor.shape);
    CHECK(bytes_of(got.tensors.at(name).values) == bytes_of(tensor.values));
  }
}

/// What reading those bytes complains about; empty if it does not.
std::string complaint(const ScratchFolder& folder, const std::string& bytes) {
  const auto path = folder.write("damaged.safetensors", bytes);
  try {
    read_safetensors(path);
  } catch (const InputError& error) {
    const std::string text = error.what();
    CHECK(text.find(path.string()) == 0);
    return text;
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("tensors and metadata come back from their file, bit for bit") {
  const ScratchFolder folder;
  Safetensors content = example();
  using Limits = std::numeric_limits<float>;
  content.tensors["odd"] = {{2, 1, 3},
                            {-0.0F, Limits::denorm_min(), Limits::infinity(), Limits::max(),
                             Limits::quiet_NaN(), -1.0F / 3.0F}};
  write_safetensors(folder / "x", content);
  check_same(read_safetensors(folder / "x"), content);
}

TEST_CASE("the file is laid out as the format specifies") {
  const ScratchFolder folder;
  const Safetensors content = example();
  write_safetensors(folder / "x", content);
  const std::string bytes = read_text_file(folder / "x");
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), 8);
  CHECK(length % 8 == 0);  // so that the tensors are aligned
  CHECK(bytes[8] == '{');  // Python's package wants it there
  const json header = header_of(bytes);
  CHECK(header.at("__metadata__") == json(content.metadata));
  CHECK(header.size() == 4);
  const std::string data = bytes.substr(8 + length);
  CHECK(data.size() == 11 * sizeof(float));
  std::size_t end_of_last = 0;
  for (const auto& [name, tensor] : content.tensors) {
    CAPTURE_BOUND(name);
    const json& entry = header.at(name);
    CHECK(entry.at("dtype") == "F32");
    CHECK(entry.at("shape") == json(tensor.shape));
    const std::size_t begin = entry.at("data_offsets").at(0), end = entry.at("data_offsets").at(1);
    CHECK(begin == end_of_last);  // no holes, nothing twice
    CHECK(data.substr(begin, end - begin) == bytes_of(tensor.values));
    end_of_last = end;
  }
  CHECK(end_of_last == data.size());
}

TEST_CASE("the same content gives the same bytes, other content others") {
  const ScratchFolder folder;
  Safetensors backwards;
  const Safetensors content = example();
  for (const char* name : {"empty", "b", "a"}) backwards.tensors[name] = content.tensors.at(name);
  backwards.metadata["two"] = content.metadata.at("two");
  backwards.metadata["one"] = content.metadata.at("one");
  write_safetensors(folder / "x", content);
  write_safetensors(folder / "y", backwards);
  CHECK(read_text_file(folder / "x") == read_text_file(folder / "y"));
  backwards.tensors["b"].values[3] += 1.0F;
  write_safetensors(folder / "y", backwards);
  CHECK(read_text_file(folder / "x") != read_text_file(folder / "y"));
}

TEST_CASE("a file is replaced as a whole: who has the old one open keeps it") {
  const ScratchFolder folder;
  Safetensors content = example();
  write_safetensors(folder / "x", content);
  const std::string before = read_text_file(folder / "x");
  std::filesystem::create_hard_link(folder / "x", folder / "old");
  content.put("b", random_matrix(3, 2, 9));
  write_safetensors(folder / "x", content);
  CHECK(read_text_file(folder / "old") == before);
  check_same(read_safetensors(folder / "x"), content);
  CHECK(files_in((folder / "x").parent_path()) == 2);  // nothing temporary is left
  CHECK_THROWS_AS(write_safetensors(folder / "nowhere/x", content), InputError);
  CHECK_THROWS_AS(read_safetensors(folder / "missing"), InputError);
}

TEST_CASE("numbers of 16 bits take half the room and come back rounded to the nearest") {
  const ScratchFolder folder;
  MatrixF values(2, 3);
  values << 1.0F, -0.1F, 1e-3F, 1.0F + 1.0F / 2048, 100.3F, 0.0F;
  Safetensors content;
  content.put("x", values);
  const auto single = folder / "single.safetensors", half = folder / "half.safetensors";
  write_safetensors(single, content);
  content.half = true;
  write_safetensors(half, content);
  CHECK(std::filesystem::file_size(single) - std::filesystem::file_size(half) == 12);
  const MatrixF got = read_safetensors(half).get("x", "half", 2, 3);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const float want = values.data()[i];
    CHECK(std::abs(got.data()[i] - want) <= std::abs(want) / 2048);  // half of 2^-10
  }
  CHECK(got != values);
}

TEST_CASE("damaged files are refused by name, with what is wrong") {
  const ScratchFolder folder;
  const std::string data = bytes_of({1, 2, 3, 4, 5, 6});
  const auto entry = [](const std::string& dtype, const std::string& shape,
                        const std::string& offsets) {
    return R"({"x": {"dtype": ")" + dtype + R"(", "shape": )" + shape + R"(, "data_offsets": )" +
           offsets + "}}";
  };
  CHECK(complaint(folder, file_of(entry("F32", "[2, 3]", "[0, 24]"), data)).empty());
  for (const char* dtype : {"F64", "BF16", "I32", ""})
    CHECK(contains(complaint(folder, file_of(entry(dtype, "[2, 3]", "[0, 24]"), data)), "F32"));
  // Data that end before the tensor does, or that are read from behind the end.
  const std::string offsets = ": x.data_offsets";
  CHECK(contains(complaint(folder, file_of(entry("F32", "[2, 3]", "[0, 24]"), data.substr(0, 23))),
                 offsets + "[1]: must be at least 0 and at most 23, not 24"));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[2, 3]", "[4, 28]"), data)), offsets));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[0]", "[25, 25]"), data)), offsets));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[2]", "[8, 0]"), data)), offsets));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[6]", "[0, 24, 24]"), data)), offsets));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[6]", "[0]"), data)), offsets));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[6]", "[-1, 24]"), data)), offsets));
  // Bytes of no tensor, before, between and behind, and bytes of two.
  const auto two = [&](const std::string& first, const std::string& second) {
    return complaint(
        folder,
        file_of(R"({"a": {"dtype": "F32", "shape": [2], "data_offsets": )" + first +
                    R"(}, "b": {"dtype": "F32", "shape": [2], "data_offsets": )" + second + "}}",
                data.substr(0, 16)));
  };
  CHECK(two("[0, 8]", "[8, 16]").empty());
  CHECK(two("[8, 16]", "[0, 8]").empty());
  CHECK(contains(two("[0, 8]", "[4, 12]"), "'b': its numbers overlap those before them"));
  CHECK(contains(two("[0, 8]", "[0, 8]"), "'b': its numbers overlap"));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[2]", "[8, 16]"), data)), "leave a hole"));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[2]", "[0, 8]"), data)),
                 "16 bytes that belong to no tensor"));
  // More or fewer bytes than the shape asks for.
  const std::string size = ": x.shape: is not that of the numbers that are there";
  for (const char* shape : {"[2, 2]", "[7]", "[]", "[2, 3, 2]", "[0, 6]",
                            "[4611686018427387904, 4]", "[4294967296, 4294967296, 6]"})
    CHECK(contains(complaint(folder, file_of(entry("F32", shape, "[0, 24]"), data)), size));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[2]", "[0, 9]"), data)), size));
  // A header that is no header.
  CHECK(contains(complaint(folder, ""), "shorter than its header"));
  CHECK(contains(complaint(folder, std::string(7, '\0')), "shorter than its header"));
  CHECK(contains(complaint(folder, file_of(entry("F32", "[2, 3]", "[0, 24]"), "").substr(0, 30)),
                 "shorter than its header"));
  CHECK(contains(complaint(folder, std::string(8, '\xff') + "{}"), "shorter than its header"));
  CHECK_FALSE(complaint(folder, file_of("{", data)).empty());
  CHECK_FALSE(complaint(folder, file_of(R"({"x": {"dtype": "F32", "shape": [6]}})", data)).empty());
  CHECK_FALSE(complaint(folder, file_of(R"({"x": {"shape": [6], "data_offsets": [0, 24]}})", data))
                  .empty());
  CHECK_FALSE(
      complaint(folder, file_of(R"({"x": {"dtype": "F32", "data_offsets": [0, 24]}})", data))
          .empty());
  CHECK_FALSE(complaint(folder, file_of(entry("F32", "[-6]", "[0, 24]"), data)).empty());
  CHECK_FALSE(complaint(folder, file_of(R"({"__metadata__": {"a": 3}})", data)).empty());
}

TEST_CASE("a matrix is asked for by name and shape") {
  Safetensors content;
  const MatrixF values = random_matrix(3, 4, 1);
  content.put("pose.0.W", values);
  CHECK(content.get("pose.0.W", "file", 3, 4) == values);
  const auto refused = [&](const std::string& name, Eigen::Index rows, Eigen::Index columns) {
    try {
      content.get(name, "the/file", rows, columns);
    } catch (const InputError& error) {
      const std::string text = error.what();
      return contains(text, "the/file") && contains(text, name) &&
             contains(text, std::to_string(rows)) && contains(text, std::to_string(columns));
    }
    return false;
  };
  CHECK(refused("pose.1.W", 3, 4));
  CHECK(refused("pose.0.W", 4, 3));
  CHECK(refused("pose.0.W", 12, 1));
  CHECK(refused("pose.0.W", 3, 5));
  content.tensors["flat"] = {{12}, std::vector<float>(12)};
  CHECK(refused("flat", 3, 4));
  content.put("pose.0.W", random_matrix(2, 2, 5));  // put again: the last one counts
  CHECK(content.get("pose.0.W", "file", 2, 2) == random_matrix(2, 2, 5));
}
