#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "mcdbn/formats/camera_file.hpp"

namespace mcdbn {

/// The file as JSON; null where it is none.
nlohmann::json camera_json(const CameraSource& source);

/// The numbers of a list, or of a list of lists, row by row.
/// @param path what stands before the key in an error: "file: cameras.L1"
/// @throws InputError naming the key's path if it is missing, not of numbers or not so many of them
std::vector<double> json_numbers(const nlohmann::json& object, const std::string& key,
                                 std::size_t count, const std::string& path);

}  // namespace mcdbn
