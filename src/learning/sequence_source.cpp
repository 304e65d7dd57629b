#include "mcdbn/learning/sequence_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "learning/unit_values.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

void check_clips(const ModalityClips& modality, const SynchronizedClips& all) {
  if (modality.clips.size() != all.count())
    throw ShapeError("sequences: the modalities differ in clips");
  for (std::size_t i = 0; i < all.count(); ++i) {
    const MatrixF& clip = modality.clips[i];
    if (static_cast<std::size_t>(clip.rows()) != all.frames(i))
      throw ShapeError("sequences: the modalities of a clip differ in frames");
    if (static_cast<std::size_t>(clip.cols()) != modality.dimension())
      throw ShapeError("sequences: the clips of a modality differ in columns");
    check_unit_values(clip, modality.kind, fmt::format("{}, clip {}", modality.name, i + 1));
  }
}

void check_seen(const ModalityClips& modality) {
  if (modality.seen.empty()) return;
  if (modality.seen.size() != modality.clips.size())
    throw ShapeError("sequences: what was seen is for all clips of a modality, or for none");
  for (std::size_t i = 0; i < modality.clips.size(); ++i) {
    const MatrixF &clip = modality.clips[i], &seen = modality.seen[i];
    if (seen.rows() != clip.rows() || seen.cols() != clip.cols())
      throw ShapeError("sequences: what was seen of a clip has another shape than the clip");
    if (!(seen.array() != 0.0F || clip.array() == 0.0F).all())
      throw ShapeError("sequences: what was not seen of a clip has to be 0 there");
  }
}

}  // namespace

bool ModalityClips::is_whole() const {
  return std::ranges::all_of(seen,
                             [](const MatrixF& values) { return (values.array() != 0.0F).all(); });
}

void SynchronizedClips::check() const {
  if (modalities.empty() || count() == 0) throw ShapeError("sequences: there are none");
  if (!groups.empty() && groups.size() != count())
    throw ShapeError("sequences: as many groups as clips, or none");
  const std::size_t last_group = groups.empty() ? 0 : *std::ranges::max_element(groups);
  if (!group_frames.empty() && last_group >= group_frames.size())
    throw ShapeError("sequences: a clip's group has no frames in the corpus");
  for (const ModalityClips& modality : modalities) {
    check_clips(modality, *this);
    check_seen(modality);
  }
}

SynchronizedClips MatrixSource::sequences() const {
  SynchronizedClips clips;
  for (const ModalityMatrices& modality : modalities_)
    clips.modalities.push_back({modality.name, modality.clips, modality.kind, modality.seen});
  clips.groups = groups_;
  return clips;
}

}  // namespace mcdbn
