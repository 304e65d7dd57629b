#pragma once

#include "mcdbn/motion/body_size.hpp"
#include "mcdbn/motion/pose_features.hpp"
#include "mcdbn/motion/standardizer.hpp"
#include "mcdbn/motion/track_features.hpp"
