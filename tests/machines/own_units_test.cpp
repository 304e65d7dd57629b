// A machine whose Gaussian units have deviations of their own: what it makes of data is what the
// same machine without them makes of the data over them, in the data's units.

#include <doctest/doctest.h>

#include <limits>

#include "device/every_device.hpp"
#include "machines/cdbn_decoder.hpp"
#include "machines/random_crbm.hpp"
#include "machines/sequence_completion.hpp"
#include "mcdbn/machines/energy.hpp"
#include "mcdbn/machines/partition.hpp"
#include "mcdbn/machines/sampling.hpp"

namespace own_units_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Powers of two, so that scaling rounds nothing.
RowVectorF deviations() {
  RowVectorF row(5);
  row << 2.0F, 0.5F, 1.0F, 8.0F, 0.25F;
  return row;
}

MatrixF over(const MatrixF& x) {
  return (x.array().rowwise() / deviations().array()).matrix();
}
MatrixF times(const MatrixF& x) {
  return (x.array().rowwise() * deviations().array()).matrix();
}

/// A machine with deviations, and the same one without.
struct Pair {
  Cdbn with, without;

  Pair(Device& device, std::size_t order, std::size_t layers) {
    CrbmParameters p = random_crbm({5, 7, order, VisibleKind::gaussian}, 3, 4.0F);
    without.layers.emplace_back(device, p);
    p.visible_deviation = deviations();
    p.visible_mean = times(p.visible_mean);
    with.layers.emplace_back(device, p);
    if (layers == 1) return;
    const CrbmParameters top = random_crbm({7, 4, order, VisibleKind::binary}, 5, 4.0F);
    for (Cdbn* cdbn : {&with, &without}) cdbn->layers.emplace_back(device, top);
  }
};

}  // namespace

TEST_CASE("small: deviations of Gaussian units scale what goes in and what comes out") {
  on_every_device([](Device& device) {
    for (const std::size_t order : {0, 2})
      for (const std::size_t layers : {1, 2}) {
        CAPTURE(order);
        CAPTURE(layers);
        const Pair machines(device, order, layers);
        const MatrixF clip = random_matrix(9, 5, 11);
        const Sequences data = Sequences::from_host(device, {clip}),
                        own = Sequences::from_host(device, {over(clip)});
        const auto host = [](const Sequences& x) { return x.values.to_host(); };
        CHECK(host(machines.with.up_pass(data)) == host(machines.without.up_pass(own)));
        CHECK(host(free_energy(machines.with, data)) == host(free_energy(machines.without, own)));
        CHECK(host(reconstruct(machines.with, data, 2)) ==
              times(host(reconstruct(machines.without, own, 2))));
        MatrixF given = clip;
        given.col(1).setConstant(std::numeric_limits<float>::quiet_NaN());
        given(8, 4) = std::numeric_limits<float>::quiet_NaN();
        const ChainSettings settings{.steps = 2, .seed = 5};
        CHECK(host(sample_given(machines.with, Sequences::from_host(device, {given}), settings)) ==
              times(host(sample_given(machines.without, Sequences::from_host(device, {over(given)}),
                                      settings))));
        CHECK(complete_sequence(machines.with, given) ==
              times(complete_sequence(machines.without, over(given))));
        // The history of the first frame is the training mean.
        const Matrix code = machines.with.up_pass(data).values;
        const auto decoded = [&](const Cdbn& cdbn, bool fused) {
          CdbnDecoder decoder(cdbn, code, 1);
          decoder.decode(order, 9, {}, fused);
          return MatrixF(decoder.visible().to_host().bottomRows(9 - static_cast<int>(order)));
        };
        for (const bool fused : {true, false})
          CHECK(decoded(machines.with, fused) == times(decoded(machines.without, fused)));
        if (order > 0) continue;
        CHECK(sample(machines.with, data.values, settings).to_host() ==
              times(sample(machines.without, own.values, settings).to_host()));
      }
  });
}

TEST_CASE("small: log Z is that of the machine's own units") {
  on_every_device([](Device& device) {
    const Pair machines(device, 2, 1);
    const MatrixF past = random_matrix(2, 5, 12);
    const RowVectorF history = past.reshaped<Eigen::RowMajor>().transpose(),
                     own = over(past).reshaped<Eigen::RowMajor>().transpose();
    const AisSettings settings{.temperatures = 5, .chains = 6};
    CHECK(log_partition(machines.with.layers[0], settings, history).value ==
          log_partition(machines.without.layers[0], settings, own).value);
  });
}

}  // namespace own_units_test
