#include "mcdbn/learning/sequence_source.hpp"

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

void SynchronizedClips::check() const {
  if (modalities.empty() || count() == 0) throw ShapeError("sequences: there are none");
  for (const ModalityClips& modality : modalities) {
    if (modality.clips.size() != count())
      throw ShapeError("sequences: the modalities differ in clips");
    for (std::size_t i = 0; i < count(); ++i)
      if (static_cast<std::size_t>(modality.clips[i].rows()) != frames(i))
        throw ShapeError("sequences: the modalities of a clip differ in frames");
  }
  if (!groups.empty() && groups.size() != count())
    throw ShapeError("sequences: as many groups as clips, or none");
}

SynchronizedClips MatrixSource::sequences() const {
  SynchronizedClips clips;
  for (const ModalityMatrices& modality : modalities_)
    clips.modalities.push_back({modality.name, modality.clips, modality.kind});
  clips.groups = groups_;
  return clips;
}

}  // namespace mcdbn
