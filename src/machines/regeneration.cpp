#include "mcdbn/machines/regeneration.hpp"

#include <algorithm>

#include "base/missing_values.hpp"
#include "base/random_streams.hpp"
#include "device/gemm.hpp"
#include "machines/cdbn_decoder.hpp"
#include "machines/mrbm_chain.hpp"
#include "machines/track_completion.hpp"
#include "mcdbn/base/errors.hpp"

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

/// The 3D code of every frame from the 2D code `look_ahead` frames later, once for each sample: its
/// own sampled chain (eq 21 to 23), or the one mean field again (eq 32, 33).
/// @param track_code sequences of one length  @return [sequences·samples·frames x dimension]
Matrix infer_pose_code(const Mcdbn& network, const Sequences& track_code,
                       const RegenerationOptions& options) {
  const std::size_t tracks = track_code.clips.size();
  const std::size_t frames = track_code.values.rows() / tracks, first = track_code.valid_from,
                    end = frames - network.look_ahead;
  const bool sampled = options.drawn_share() > 0.0 && options.sampling.mrbm_gibbs_steps > 0;
  const std::size_t chains = sampled ? options.samples : 1, rows = tracks * chains;
  Device& device = track_code.values.device();
  Matrix code(device, rows * frames, network.pose.code_dimension());
  if (!sampled) {
    const std::size_t count = end - first;
    for (std::size_t i = 0; i < tracks; ++i)
      network.mrbm.infer(Modality::track,
                         Rows(track_code.values, i * frames + first + network.look_ahead, count),
                         network.mean_field_steps, Rows(code, i * frames + first, count));
    return repeated(code, tracks, options.samples);
  }
  MrbmChainOptions chain;
  chain.steps = options.sampling.mrbm_gibbs_steps;
  chain.temperature = static_cast<float>(options.drawn_share());
  if (options.sampling.steady) chain.sampling = Sampling::concrete;
  // A frame of all samples at a time: a sample is the same row in every frame, and so are its
  // draws.
  std::vector<std::int32_t> start;
  for (std::size_t i = 0; i < rows; ++i)
    start.push_back(static_cast<std::int32_t>(i / chains * frames));
  const IndexBuffer index(device, start);
  MrbmChain inference(network.mrbm, Modality::track, rows);
  for (std::size_t frame = first; frame < end; ++frame) {
    const auto step = options.sampling.steady ? 0U : static_cast<std::uint32_t>(frame);
    chain.random = {options.seed, step, random_streams::kMrbmChain, 0};
    inference.run(Rows::indexed(track_code.values, index, 0, rows,
                                static_cast<int>(frame + network.look_ahead)),
                  chain, Rows::strided(code, frame, rows, frames));
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
  sequences.reserve(tracks.size());
  for (const MatrixF& track : tracks)
    sequences.push_back(extended(
        network.fills_gaps ? complete_track(network.track, track) : at_mean_where_unknown(track),
        static_cast<Eigen::Index>(lead), static_cast<Eigen::Index>(frames)));
  Device& device = network.mrbm.device();
  const Sequences track_code = network.track.up_pass(Sequences::from_host(device, sequences));
  const std::size_t decoded = sequences.size() * options.samples;
  const Matrix code = infer_pose_code(network, track_code, options);
  CdbnDecoder decoder(network.pose, code, decoded);
  decoder.decode(start, frames - network.look_ahead, options);

  const MatrixF visible = decoder.visible().to_host();
  std::vector<MatrixF> result;
  for (std::size_t i = 0; i < decoded; ++i)
    result.emplace_back(visible.middleRows(static_cast<Eigen::Index>(i * frames + lead),
                                           tracks[i / options.samples].rows()));
  return result;
}

MatrixF single_answer(const Mcdbn& network, const MatrixF& track) {
  return regenerate(network, {track}).front();
}

}  // namespace mcdbn
