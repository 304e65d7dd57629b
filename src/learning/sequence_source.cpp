#include "mcdbn/learning/sequence_source.hpp"

#include <algorithm>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace {

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
  for (const ModalityClips& modality : modalities) {
    if (modality.clips.size() != count())
      throw ShapeError("sequences: the modalities differ in clips");
    for (std::size_t i = 0; i < count(); ++i)
      if (static_cast<std::size_t>(modality.clips[i].rows()) != frames(i))
        throw ShapeError("sequences: the modalities of a clip differ in frames");
    check_seen(modality);
  }
  if (!groups.empty() && groups.size() != count())
    throw ShapeError("sequences: as many groups as clips, or none");
}

SynchronizedClips MatrixSource::sequences() const {
  SynchronizedClips clips;
  for (const ModalityMatrices& modality : modalities_)
    clips.modalities.push_back({modality.name, modality.clips, modality.kind, modality.seen});
  clips.groups = groups_;
  return clips;
}

}  // namespace mcdbn
