#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Acclaim's pair of files, in which CMU gives away its captures: the ASF holds bones with an axis
/// system each, the AMC their angles.
///
/// A bone becomes the joint at its nearer end, with three rotation channels: its turn C·M·C⁻¹, C
/// its axes and M its angles. At rest all are zero. Lengths become centimetres: a unit is 2.54 cm
/// over the ASF's `length`. Limits and masses are ignored.
/// @param asf, amc the texts; the names stand for them in messages
/// @param warnings if given, collects what was taken for granted
/// @throws InputError `file:line: what`
Motion parse_asf_amc(std::string_view asf, const std::string& asf_name, std::string_view amc,
                     const std::string& amc_name, std::vector<std::string>* warnings);

/// The joints that parse_asf_amc() makes of an ASF. @throws InputError `name:line: what`
Skeleton parse_asf_skeleton(std::string_view asf, const std::string& name);

}  // namespace mcdbn
