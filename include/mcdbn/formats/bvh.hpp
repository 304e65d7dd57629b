// The room formats: files of motion, tracks and cameras.
// It uses camera.
// Add here: a format: a source file of its own (track_csv.cpp shows the pattern) and a line in
// track_file.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Reads a BVH file; accepts the variants in use: rotation orders mixed within a file, rotation
/// before position, position channels on any joint, tabs and spaces after `Frames:`, blank lines,
/// exponents, CRLF, no final newline.
/// @param warnings if given, collects one line for each thing that was accepted but odd
///        (`file:line: what`), such as more frame lines than `Frames:` gives.
/// @throws InputError `file:line: what`
Motion read_bvh(const std::filesystem::path& path, std::vector<std::string>* warnings = nullptr);

/// As read_bvh(), from text. @param name of the file, for messages
Motion parse_bvh(std::string_view text, const std::string& name,
                 std::vector<std::string>* warnings = nullptr);

/// The HIERARCHY section alone, as a BVH reader would take it. Stored in model files.
std::string bvh_header_text(const Skeleton& skeleton);
/// @throws InputError
Skeleton parse_bvh_header(std::string_view text, const std::string& name);

/// The whole file as text: channels in the skeleton's own order, enough digits that
/// read → write → read keeps 1e-4 degrees or units.
std::string bvh_text(const Motion& motion);
/// Writes atomically (temporary file, then rename): no partial file is left behind.
/// @throws InputError
void write_bvh(const std::filesystem::path& path, const Motion& motion);

}  // namespace mcdbn
