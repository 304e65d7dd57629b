#include "evaluation/method_names.hpp"

#include <algorithm>
#include <array>

#include "evaluation/report_clip.hpp"

namespace mcdbn {
namespace {

constexpr std::array kNames = {
    MethodName{"model", "model", "the model", "The network that is tested."},
    MethodName{kMeanField, "model, mean field", "the model's mean field",
               "The network's single answer, nothing drawn."},
    MethodName{"mean_pose", "constant mean pose", "the constant mean pose",
               "The mean of all training poses, whatever the track shows."},
    MethodName{"hold_last_frame", "one pose held", "one pose held throughout",
               "The nearest neighbour's pose for the first frame, held."},
    MethodName{"nearest_neighbour", "nearest neighbour", "the nearest neighbour",
               "The pose of the training frame whose 2D is nearest."},
    MethodName{"ridge_window", "ridge regression", "ridge regression",
               "A linear map from 11 frames of 2D to the pose."},
    MethodName{"mlp_window", "MLP", "the MLP",
               "A perceptron with two hidden layers on 11 frames of 2D."},
    MethodName{"bimodal_autoencoder", "bimodal autoencoder", "the bimodal autoencoder",
               "A deep autoencoder of 2D and 3D with a shared layer, taught to restore both from "
               "either (Ngiam et al. 2011)."},
    MethodName{"multimodal_dbm", "multimodal DBM", "the multimodal DBM",
               "A deep Boltzmann machine of 2D and 3D with a joint layer; 3D is inferred by mean "
               "field (Srivastava and Salakhutdinov 2014)."},
    MethodName{"twin_gaussian_process", "twin Gaussian processes", "twin Gaussian processes",
               "The pose that is as similar to training poses as the 2D is to theirs, by the KL "
               "divergence of two Gaussian processes (Bo and Sminchisescu 2010)."}};

}  // namespace

MethodName method_name(std::string_view key) {
  const auto found = std::find_if(kNames.begin(), kNames.end(),
                                  [key](const MethodName& name) { return name.key == key; });
  return found == kNames.end() ? MethodName{key, key, key, ""} : *found;
}

}  // namespace mcdbn
