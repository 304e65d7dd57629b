#pragma once

#include "mcdbn/machines/crbm.hpp"
#include "reference/crbm_reference.hpp"

namespace mcdbn::test {

/// Parameters as the reference takes them.
inline reference::Crbm in_double(const CrbmParameters& p) {
  return {p.shape.kind == VisibleKind::gaussian ? reference::VisibleUnits::gaussian
                                                : reference::VisibleUnits::binary,
          p.W.cast<double>(),
          p.A.cast<double>(),
          p.B.cast<double>(),
          p.a.cast<double>(),
          p.b.cast<double>()};
}

}  // namespace mcdbn::test
