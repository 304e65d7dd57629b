#pragma once

#include "device/every_device.hpp"
#include "features/small_figure.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn::test {

/// Everything that a model file holds, each field with a value of its own that is not its default.
struct ExampleModel {
  std::vector<CrbmParameters> track, pose;
  MrbmParameters mrbm;
  SmallFigure figure;

  /// @param equal every layer of either modality, and the MRBM, has as many units: then a tensor
  ///        in another's place would fit
  explicit ExampleModel(bool equal) {
    const std::size_t n = equal ? 6 : 0;
    const auto layer = [&](std::size_t visible, std::size_t hidden, std::size_t order,
                           VisibleKind kind) {
      return filled({n ? n : visible, n ? n : hidden, n ? 2 : order, kind});
    };
    track = {layer(5, 7, 2, VisibleKind::gaussian), layer(7, 4, 1, VisibleKind::binary)};
    pose = {layer(9, 8, 3, VisibleKind::gaussian), layer(8, 3, 2, VisibleKind::binary),
            layer(3, 6, 1, VisibleKind::binary)};
    const std::size_t hidden = n ? n : 11;
    const std::size_t codes[] = {track.back().shape.hidden, pose.back().shape.hidden};
    mrbm = mrbm_of({next(codes[0], hidden), next(codes[1], hidden)},
                   {next(1, codes[0]), next(1, codes[1])}, next(1, hidden));
  }

  Model on(Device& device) const {
    Mcdbn network{std::vector<Cdbn>(2), Mrbm(device, mrbm), 4, 6};
    for (const CrbmParameters& p : track) network.cdbns[0].layers.emplace_back(device, p);
    for (const CrbmParameters& p : pose) network.cdbns[1].layers.emplace_back(device, p);
    network.sampling = {
        .gibbs_steps = 5, .mrbm_gibbs_steps = 3, .steady = true, .scale = 0.7, .sampled = true};
    network.fills_gaps = false;
    return {std::move(network),
            modalities(),
            {{"/folder/a.bvh", "0012", {}, "Anna", "walk"}, {"/other/b.bvh", "ff00"}},
            {{"seed", 9},
             {"fps", 24.5},
             {"order", 3},
             {"layers", 2},
             {"hidden", 31},
             {"mrbm-hidden", 17},
             {"camera", {{"azimuth", -40.0}, {"elevation", 7.5}, {"fov", 61.0}}},
             {"rate", 1e-3},
             {"name", "walk"}},
            EarlyStopping{{"c.bvh", "d.bvh"}, 75, 1.0 / 3.0}};
  }

  /// Its features are the small figure's; scales have columns that never change, and as many that
  /// do as the lowest layers have units.
  Modalities modalities() const {
    Modalities result = figure.modalities();
    result.pose_scale = scale(result.pose_features.dimension(), 1, pose.front().shape.visible);
    result.track_scale = scale(result.track_features.dimension(), 2, track.front().shape.visible);
    result.fps = 24.5;
    result.camera = {-35.25, 12.5, 321.5, 50.75, 1280, 721};
    return result;
  }

 private:
  CrbmParameters filled(const CrbmShape& shape) {
    CrbmParameters p = CrbmParameters::zeros(shape);
    for (MatrixF* matrix : {&p.W, &p.A, &p.B, &p.a, &p.b, &p.visible_mean})
      *matrix =
          next(static_cast<std::size_t>(matrix->rows()), static_cast<std::size_t>(matrix->cols()));
    return p;
  }
  MatrixF next(std::size_t rows, std::size_t columns) {
    return random_matrix(rows, columns, ++seed_, 1.0F);
  }
  /// The columns that vary are spread among the others.
  static Standardizer scale(int columns, unsigned seed, std::size_t varying) {
    MatrixD values =
        random_matrix(20, static_cast<std::size_t>(columns), seed, 3.0F).cast<double>();
    const int kept = static_cast<int>(varying);
    for (int column = 0; column < columns; ++column)
      if (column * kept / columns == (column + 1) * kept / columns)
        values.col(column).setConstant(0.1 * (column + 1));
    return Standardizer::fit({&values});
  }

  unsigned seed_ = 0;
};

}  // namespace mcdbn::test
