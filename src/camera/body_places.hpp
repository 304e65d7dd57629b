#pragma once

#include <string>
#include <string_view>

#include "mcdbn/camera/keypoint.hpp"

namespace mcdbn {

/// A place on the body by its plain name, "left_eye", "mid_hip": the joint that carries it and
/// where it lies. Its `name` is that plain name. None: no such place.
std::optional<Keypoint> body_place(std::string_view name);

/// The plain name that a file's spelling stands for, or an empty text.
std::string place_name_of(std::string_view spelling);

}  // namespace mcdbn
