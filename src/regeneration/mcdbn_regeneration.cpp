#include "mcdbn/regeneration/mcdbn_regeneration.hpp"

#include <algorithm>

#include "mcdbn/errors.hpp"
#include "mcdbn/regeneration/cdbn_decoder.hpp"
#include "mcdbn/regeneration/track_completion.hpp"

namespace mcdbn {
namespace {

/// `lead` copies of the first row, the track, then its end carried on up to `frames` rows: turned
/// about the last row, point by point, so that what the look-ahead sees there moves on as it did.
MatrixF extended(const MatrixF& track, Eigen::Index lead, Eigen::Index frames) {
  MatrixF result(frames, track.cols());
  const Eigen::Index last = track.rows() - 1;
  result.topRows(lead) = track.row(0).replicate(lead, 1);
  result.middleRows(lead, track.rows()) = track;
  for (Eigen::Index i = 1; lead + last + i < frames; ++i)
    result.row(lead + last + i) =
        2.0F * track.row(last) - track.row(std::max<Eigen::Index>(last - i, 0));
  return result;
}

/// Each sequence `copies` times in a row. @param code [sequences·frames x dimension]
Matrix repeated(const Matrix& code, std::size_t sequences, std::size_t copies) {
  if (copies == 1) return code;
  Matrix result(code.device(), code.rows() * copies, code.columns());
  const std::size_t frames = code.rows() / sequences;
  for (std::size_t i = 0; i < sequences * copies; ++i)
    result.copy_rows_from(code, i / copies * frames, frames, i * frames);
  return result;
}

/// The 3D code of every frame from the 2D code `look_ahead` frames later (eq 32, 33).
Matrix infer_pose_code(const Mcdbn& network, const Sequences& track_code) {
  Matrix code(track_code.values.device(), track_code.values.rows(), network.pose.code_dimension());
  for (const auto& clip : track_code.clips) {
    const std::size_t first = clip.first + track_code.valid_from;
    const std::size_t count = clip.frames - track_code.valid_from - network.look_ahead;
    network.mrbm.infer(Modality::track, Rows(track_code.values, first + network.look_ahead, count),
                       network.mean_field_steps, Rows(code, first, count));
  }
  return code;
}

}  // namespace

std::vector<MatrixF> regenerate(const Mcdbn& network, const std::vector<MatrixF>& tracks,
                                const RegenerationOptions& options) {
  if (tracks.empty() || options.samples == 0) return {};
  std::size_t pose_order = 0;
  for (const Crbm& layer : network.pose.layers)
    pose_order = std::max(pose_order, layer.shape().order);
  // Before the clip: what the up-pass needs, then the run-in, both of the first frame repeated.
  const std::size_t start = std::max(network.track.total_order(), pose_order);
  const std::size_t lead = start + options.run_in;
  std::size_t longest = 0;
  for (const MatrixF& track : tracks) {
    if (track.rows() == 0) throw ShapeError("regenerate: a track without frames");
    longest = std::max(longest, static_cast<std::size_t>(track.rows()));
  }
  const std::size_t frames = lead + longest + network.look_ahead;

  std::vector<MatrixF> sequences;
  for (const MatrixF& track : tracks)
    sequences.push_back(extended(complete_track(network.track, track),
                                 static_cast<Eigen::Index>(lead),
                                 static_cast<Eigen::Index>(frames)));
  Device& device = network.mrbm.device();
  const Sequences track_code = network.track.up_pass(Sequences::from_host(device, sequences));
  // A track's samples differ in the decoder only.
  const std::size_t decoded = sequences.size() * options.samples;
  const Matrix code =
      repeated(infer_pose_code(network, track_code), sequences.size(), options.samples);
  CdbnDecoder decoder(network.pose, code, decoded);
  decoder.decode(start, frames - network.look_ahead, options);

  const MatrixF visible = decoder.visible().to_host();
  std::vector<MatrixF> result;
  for (std::size_t i = 0; i < decoded; ++i)
    result.emplace_back(visible.middleRows(static_cast<Eigen::Index>(i * frames + lead),
                                           tracks[i / options.samples].rows()));
  return result;
}

}  // namespace mcdbn
