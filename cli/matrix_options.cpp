#include "matrix_options.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iostream>
#include <utility>

#include "base/counted.hpp"
#include "learning/unit_values.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/matrix_file.hpp"

namespace mcdbn::cli {
namespace {

const ColumnScale* scale_of(const SavedMachine& saved, std::size_t modality) {
  const bool has_one = modality < saved.scales.size() && saved.scales[modality].mean.cols() > 0;
  return has_one ? &saved.scales[modality] : nullptr;
}

}  // namespace

std::vector<MatrixF> MatrixInput::read() const {
  std::vector<MatrixF> data;
  for (const std::filesystem::path& file : files) {
    data.push_back(read_matrix(file, tensor));
    if (data.back().cols() != data.front().cols())
      throw InputError(fmt::format("{}: {} columns, {} in {}", file.string(), data.back().cols(),
                                   data.front().cols(), files.front().string()));
  }
  return data;
}

CLI::Option* add_matrix_input(CLI::App& command, MatrixInput& input, const std::string& name,
                              const std::string& help) {
  command.add_option("--tensor", input.tensor,
                     "Name of the tensor to read of .safetensors files with several");
  return command.add_option(name, input.files, help)->type_name("FILE");
}

void add_matrix_output(CLI::App& command, CommandContext& context, std::filesystem::path& output,
                       const char* help) {
  mark_output(command.add_option("-o,--output", output, help), context)->type_name("FILE");
}

void check_matrix_output(const std::filesystem::path& output) {
  if (!output.empty() && !is_matrix_file(output))
    throw ConfigError(
        fmt::format("--output {}: give a .npy, a .csv or a .safetensors", output.string()));
}

void put_matrix(const std::filesystem::path& output, const MatrixF& values) {
  if (output.empty())
    write_csv(std::cout, values);
  else
    write_matrix(output, values);
}

void add_machine_option(CLI::App& command, std::filesystem::path& model) {
  command.add_option("--model", model, "Machine that `mcdbn-cl fit` wrote")
      ->required()
      ->type_name("FILE");
}

Cdbn stack_of(const SavedMachine& saved, const std::filesystem::path& file) {
  if (const Crbm* crbm = std::get_if<Crbm>(&saved.machine)) return {{*crbm}};
  if (const Cdbn* cdbn = std::get_if<Cdbn>(&saved.machine)) return *cdbn;
  if (std::holds_alternative<Mrbm>(saved.machine))
    throw InputError(
        fmt::format("{}: an MRBM; its data are given by --modality NAME=FILE", file.string()));
  throw InputError(fmt::format("{}: an MCDBN; this command takes a single machine", file.string()));
}

std::vector<MatrixF> scaled(const SavedMachine& saved, std::vector<MatrixF> data,
                            std::size_t visible, const MatrixInput& files, std::size_t modality) {
  const ColumnScale* scale = scale_of(saved, modality);
  for (MatrixF& values : data) {
    if (values.cols() != static_cast<Eigen::Index>(visible))
      throw InputError(fmt::format("{}: {} columns; the machine has {} visible units",
                                   files.files.front().string(), values.cols(), visible));
    if (scale) values = scale->apply(values);
  }
  return data;
}

MatrixF unscaled(const SavedMachine& saved, const MatrixF& values, std::size_t modality) {
  const ColumnScale* scale = scale_of(saved, modality);
  return scale ? scale->undo(values) : values;
}

void check_lengths(const std::vector<MatrixF>& data, std::size_t order,
                   const std::vector<std::filesystem::path>& files) {
  const auto is_short = [&](const MatrixF& values) {
    return values.rows() <= static_cast<Eigen::Index>(order);
  };
  if (std::ranges::all_of(data, is_short))
    throw InputError(fmt::format("{}: no file has more than {} rows, the history of the machine",
                                 files.front().string(), order));
  for (std::size_t i = 0; i < data.size(); ++i)
    if (is_short(data[i]))
      spdlog::warn("{}: {}; none has the machine's history of {} before it", files[i].string(),
                   counted(data[i].rows(), "row"), counted(order, "row"));
}

std::vector<MatrixF> checked_and_scaled(const SavedMachine& saved, const Cdbn& stack,
                                        const MatrixInput& files) {
  const CrbmShape shape = stack.layers.front().shape();
  std::vector<MatrixF> data = files.read();
  for (std::size_t i = 0; i < data.size(); ++i)
    check_unit_values(data[i], shape.kind, files.files[i].string());
  data = scaled(saved, std::move(data), shape.visible, files);
  check_lengths(data, stack.total_order(), files.files);
  return data;
}

MatrixF stacked(const std::vector<MatrixF>& sequences, std::size_t first) {
  const auto from = static_cast<Eigen::Index>(first);
  Eigen::Index rows = 0;
  for (const MatrixF& values : sequences) rows += std::max<Eigen::Index>(values.rows() - from, 0);
  MatrixF all(rows, sequences.empty() ? 0 : sequences.front().cols());
  Eigen::Index at = 0;
  for (const MatrixF& values : sequences) {
    const Eigen::Index count = std::max<Eigen::Index>(values.rows() - from, 0);
    all.middleRows(at, count) = values.bottomRows(count);
    at += count;
  }
  return all;
}

}  // namespace mcdbn::cli
