#include "mcdbn/machines/regeneration.hpp"

#include <algorithm>
#include <optional>

#include "base/missing_values.hpp"
#include "base/random_streams.hpp"
#include "device/gemm.hpp"
#include "machines/cdbn_decoder.hpp"
#include "machines/mirrored_continuation.hpp"
#include "machines/mrbm_chain.hpp"
#include "machines/sequence_completion.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// `before` copies of the first row, the sequence, then its mirrored_continuation, `frames` rows in
/// all.
MatrixF extended(const MatrixF& sequence, Eigen::Index before, Eigen::Index frames,
                 VisibleKind kind) {
  MatrixF result(frames, sequence.cols());
  const Eigen::Index behind = frames - before - sequence.rows();
  result << sequence.row(0).replicate(before, 1), sequence,
      mirrored_continuation(sequence, behind, kind);
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

/// Which frames are inferred and decoded. Frame t of the network is that of all modalities without
/// a look-ahead.
struct Frames {
  std::size_t first = 0;    ///< of the network: every present modality has a code from here on
  std::size_t start = 0;    ///< of the wanted modality: decoded from here on
  std::size_t begin = 0;    ///< of a sequence, behind the history and the run-in
  std::size_t longest = 0;  ///< frames of a sequence
  std::size_t end = 0;      ///< of the network, behind the last
  std::size_t total = 0;    ///< that the present modalities must show
};

Frames frames_of(const Mcdbn& network, const std::vector<std::vector<MatrixF>>& present,
                 std::size_t wanted, std::size_t run_in) {
  Frames frames;
  std::size_t latest = network.ahead(wanted);
  for (std::size_t m = 0; m < present.size(); ++m) {
    if (present[m].empty()) continue;
    frames.first = std::max(frames.first, network.cdbns[m].total_order());
    latest = std::max(latest, network.ahead(m));
    for (const MatrixF& sequence : present[m])
      frames.longest = std::max(frames.longest, static_cast<std::size_t>(sequence.rows()));
  }
  frames.start = frames.first + network.ahead(wanted);
  for (const Crbm& layer : network.cdbns[wanted].layers)
    frames.start = std::max(frames.start, layer.shape().order);
  frames.begin = frames.start + run_in;
  frames.end = frames.begin + frames.longest - network.ahead(wanted);
  frames.total = frames.end + latest;
  return frames;
}

/// The present modalities' codes and, where the wanted one's go, its rows of the network's frames.
struct Codes {
  std::vector<std::optional<Sequences>> present;  ///< all of one length
  Matrix wanted;                                  ///< [sequences·samples·frames x dimension]
  std::vector<Matrix> others;  ///< inferred, of modalities neither present nor wanted
};

/// Whether each modality's code is given to the MRBM.
std::vector<bool> present_flags(const Codes& codes) {
  std::vector<bool> flags;
  for (const auto& code : codes.present) flags.push_back(code.has_value());
  return flags;
}

/// The one mean field for all samples (eq 32, 33), of every sequence.
void infer_means(const Mcdbn& network, const Frames& frames, std::size_t wanted,
                 std::size_t sequences, Codes& codes) {
  const std::size_t count = frames.end - frames.first;
  for (std::size_t i = 0; i < sequences; ++i) {
    std::vector<Rows> rows;
    for (std::size_t m = 0; m < network.modality_count(); ++m) {
      const std::size_t at = i * frames.total + frames.first + network.ahead(m);
      if (codes.present[m])
        rows.emplace_back(codes.present[m]->values, at, count);
      else if (m == wanted)
        rows.emplace_back(codes.wanted, at, count);
      else
        rows.emplace_back(codes.others[m], 0, count);
    }
    network.mrbm.infer(rows, present_flags(codes), network.mean_field_steps);
  }
}

/// A sampled chain of its own for every sample (eq 21 to 23). A frame of all samples at a time: a
/// sample is the same row in every frame, and so are its draws.
void infer_samples(const Mcdbn& network, const Frames& frames, std::size_t wanted,
                   std::size_t sequences, const RegenerationOptions& options, Codes& codes) {
  MrbmChainOptions chain;
  chain.steps = options.sampling.mrbm_gibbs_steps;
  chain.temperature = static_cast<float>(options.drawn_share());
  if (options.sampling.steady) chain.sampling = Sampling::concrete;
  chain.steps_apart = static_cast<std::uint32_t>(frames.total);
  const std::size_t count = sequences * options.samples;
  std::vector<std::int32_t> start;
  for (std::size_t i = 0; i < count; ++i)
    start.push_back(static_cast<std::int32_t>(i / options.samples * frames.total));
  const IndexBuffer index(network.mrbm.device(), start);
  MrbmChain inference(network.mrbm, present_flags(codes), count);
  for (std::size_t frame = frames.first; frame < frames.end; ++frame) {
    const auto step = options.sampling.steady ? 0U : static_cast<std::uint32_t>(frame);
    chain.random = {options.seed, step, random_streams::kMrbmChain, 0};
    std::vector<Rows> rows;
    for (std::size_t m = 0; m < network.modality_count(); ++m) {
      const std::size_t at = frame + network.ahead(m);
      if (codes.present[m])
        rows.push_back(
            Rows::indexed(codes.present[m]->values, index, 0, count, static_cast<int>(at)));
      else if (m == wanted)
        rows.push_back(Rows::strided(codes.wanted, at, count, frames.total));
      else
        rows.emplace_back(codes.others[m], 0, count);
    }
    inference.run(rows, chain);
  }
}

/// @return [sequences·samples·frames.total x dimension]
Matrix infer_code(const Mcdbn& network, const Frames& frames, std::size_t wanted,
                  std::vector<std::optional<Sequences>> present, std::size_t sequences,
                  const RegenerationOptions& options) {
  const bool sampled = options.samples_mrbm();
  const std::size_t count = sampled ? sequences * options.samples : sequences;
  Device& device = network.mrbm.device();
  Codes codes{std::move(present),
              Matrix(device, count * frames.total, network.mrbm.visible(wanted)),
              std::vector<Matrix>(network.modality_count())};
  for (std::size_t m = 0; m < network.modality_count(); ++m)
    if (!codes.present[m] && m != wanted)
      codes.others[m] = Matrix(device, std::max(count, frames.total), network.mrbm.visible(m));
  if (sampled) {
    infer_samples(network, frames, wanted, sequences, options, codes);
    return std::move(codes.wanted);
  }
  infer_means(network, frames, wanted, sequences, codes);
  return repeated(codes.wanted, sequences, options.samples);
}

/// How many sequences there are. @throws ShapeError
std::size_t sequence_count(const Mcdbn& network, const std::vector<std::vector<MatrixF>>& present,
                           std::size_t wanted) {
  if (present.size() != network.modality_count() || wanted >= present.size() ||
      !present[wanted].empty())
    throw ShapeError("regenerate: needs sequences of every modality but the one asked for");
  std::size_t count = 0;
  const std::vector<MatrixF>* first = nullptr;
  for (const auto& sequences : present) {
    if (sequences.empty()) continue;
    if (!first) first = &sequences;
    count = sequences.size();
    if (count != first->size()) throw ShapeError("regenerate: the modalities differ in sequences");
    for (std::size_t i = 0; i < count; ++i) {
      if (sequences[i].rows() == 0) throw ShapeError("regenerate: a sequence without frames");
      if (sequences[i].rows() != (*first)[i].rows())
        throw ShapeError("regenerate: the modalities differ in frames");
    }
  }
  return count;
}

Sequences code_of(const Mcdbn& network, std::size_t modality, const std::vector<MatrixF>& present,
                  const Frames& frames) {
  const Cdbn& cdbn = network.cdbns[modality];
  std::vector<MatrixF> sequences;
  sequences.reserve(present.size());
  for (const MatrixF& sequence : present)
    sequences.push_back(extended(
        network.fills_gaps ? complete_sequence(cdbn, sequence) : at_mean_where_unknown(sequence),
        static_cast<Eigen::Index>(frames.begin), static_cast<Eigen::Index>(frames.total),
        cdbn.layers.front().shape().kind));
  return cdbn.up_pass(Sequences::from_host(network.mrbm.device(), sequences));
}

/// Codes of the wanted modality and the frames decoded from them, [decoded·frames.total x …].
struct Decoded {
  Frames frames;
  Matrix code, visible;
  std::vector<Eigen::Index> lengths;  ///< of each decoded sequence

  /// The rows of each decoded sequence.
  std::vector<MatrixF> sequences_of(const Matrix& matrix) const {
    const MatrixF values = matrix.to_host();
    std::vector<MatrixF> sequences;
    sequences.reserve(lengths.size());
    for (std::size_t i = 0; i < lengths.size(); ++i)
      sequences.emplace_back(values.middleRows(
          static_cast<Eigen::Index>(i * frames.total + frames.begin), lengths[i]));
    return sequences;
  }
};

/// @param present at least one sequence of one modality, options.samples above 0
Decoded decoded(const Mcdbn& network, const std::vector<std::vector<MatrixF>>& present,
                std::size_t wanted, std::size_t sequences, const RegenerationOptions& options) {
  Decoded result{frames_of(network, present, wanted, options.run_in), {}, {}, {}};
  const Frames& frames = result.frames;
  std::vector<std::optional<Sequences>> present_codes(present.size());
  const std::vector<MatrixF>* shown = &present.front();
  for (std::size_t m = 0; m < present.size(); ++m) {
    if (present[m].empty()) continue;
    present_codes[m] = code_of(network, m, present[m], frames);
    shown = &present[m];
  }
  for (std::size_t i = 0; i < sequences * options.samples; ++i)
    result.lengths.push_back((*shown)[i / options.samples].rows());
  result.code = infer_code(network, frames, wanted, std::move(present_codes), sequences, options);
  CdbnDecoder decoder(network.cdbns[wanted], result.code, result.lengths.size());
  decoder.decode(frames.start, frames.begin + frames.longest, options);
  result.visible = decoder.visible();
  return result;
}

}  // namespace

std::vector<MatrixF> regenerate(const Mcdbn& network,
                                const std::vector<std::vector<MatrixF>>& present,
                                std::size_t wanted, const RegenerationOptions& options) {
  const std::size_t sequences = sequence_count(network, present, wanted);
  if (sequences == 0 || options.samples == 0) return {};
  const Decoded all = decoded(network, present, wanted, sequences, options);
  return all.sequences_of(all.visible);
}

std::vector<MatrixF> regenerate(const Mcdbn& network, const std::vector<MatrixF>& first,
                                const RegenerationOptions& options) {
  return regenerate(network, {first, {}}, 1, options);
}

MatrixF single_answer(const Mcdbn& network, const MatrixF& first) {
  return regenerate(network, std::vector<MatrixF>{first}).front();
}

std::vector<CodedAnswer> coded_answers(const Mcdbn& network, const std::vector<MatrixF>& first,
                                       const RegenerationOptions& options) {
  const std::vector<std::vector<MatrixF>> present{first, {}};
  const std::size_t sequences = sequence_count(network, present, 1);
  if (sequences == 0 || options.samples == 0) return {};
  const Decoded all = decoded(network, present, 1, sequences, options);
  std::vector<MatrixF> means = all.sequences_of(all.visible), codes = all.sequences_of(all.code);
  std::vector<CodedAnswer> answers;
  for (std::size_t i = 0; i < means.size(); ++i)
    answers.push_back({std::move(means[i]), std::move(codes[i])});
  return answers;
}

}  // namespace mcdbn
