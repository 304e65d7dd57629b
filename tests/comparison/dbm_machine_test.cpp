// A multimodal DBM small enough to enumerate: its energy's gradient, its conditionals, its mean
// field, and where its chains go.

#include "comparison/dbm_machine.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "comparison/clips.hpp"
#include "device/every_device.hpp"
#include "reference/units_reference.hpp"

namespace dbm_machine_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::sigmoid;

namespace {

const BimodalShape kShape{{3, 2}, {3, 2}, 2};

/// Everything in double.
struct Reference {
  std::array<MatrixD, 2> W, U, a, b;
  MatrixD c;

  /// One configuration each a row vector.
  double energy(const std::array<RowVectorD, 2>& v, const std::array<RowVectorD, 2>& h,
                const RowVectorD& z) const {
    double sum = -c.row(0).dot(z);
    for (std::size_t m = 0; m < 2; ++m)
      sum += 0.5 * (v[m] - a[m].row(0)).squaredNorm() - (v[m] * W[m]).dot(h[m]) -
             b[m].row(0).dot(h[m]) - (h[m] * U[m]).dot(z);
    return sum;
  }
};

Reference reference_of(const Parameters& parameters) {
  const auto get = [&](const std::string& name) {
    return MatrixD(parameters.to_host(name).cast<double>());
  };
  return {{get("W_track"), get("W_pose")},
          {get("U_track"), get("U_pose")},
          {get("a_track"), get("a_pose")},
          {get("b_track"), get("b_pose")},
          get("c")};
}

DbmMachine some_machine(Device& device) {
  DbmMachine machine(device, kShape, {1, 0, 9, 0});
  Parameters parameters = machine.parameters();
  unsigned seed = 20;
  for (const auto& entry : parameters.entries())
    parameters.upload(entry.name, 0.7F * random_clip(static_cast<int>(entry.rows),
                                                     static_cast<int>(entry.columns), seed++));
  machine.refresh_transposed();
  return machine;
}

/// Bits of `state` as units.
RowVectorD bits(unsigned state, Eigen::Index count) {
  RowVectorD units(count);
  for (Eigen::Index i = 0; i < count; ++i) units(i) = (state >> i) & 1U;
  return units;
}

}  // namespace

TEST_CASE("multimodal DBM: conditionals are those of the energy") {
  on_every_device([](Device& device) {
    const DbmMachine machine = some_machine(device);
    const Reference reference = reference_of(machine.parameters());
    DbmMachine::Units units(device, kShape, 4);
    const std::array<MatrixF, 2> v = {random_clip(4, 3, 1), random_clip(4, 2, 2)};
    for (std::size_t m = 0; m < 2; ++m) units.visible[m].upload(v[m]);
    MatrixF z(4, 2);
    z << 0, 0, 1, 0, 0, 1, 1, 1;
    units.joint.upload(z);
    std::array<MatrixD, 2> h;
    for (std::size_t m = 0; m < 2; ++m) {
      machine.set_input_from_below(m, units);
      machine.infer_hidden(m, units);
      h[m] = units.hidden[m].to_host().cast<double>();
    }
    machine.infer_joint(units.hidden, units);
    const MatrixD joint = units.joint.to_host().cast<double>();
    for (Eigen::Index r = 0; r < 4; ++r) {
      const std::array<RowVectorD, 2> row = {v[0].row(r).cast<double>(),
                                             v[1].row(r).cast<double>()};
      for (std::size_t m = 0; m < 2; ++m)
        for (Eigen::Index j = 0; j < h[m].cols(); ++j) {
          // The other hidden units do not matter: all are off.
          std::array<RowVectorD, 2> off = {RowVectorD::Zero(3), RowVectorD::Zero(2)}, on = off;
          on[m](j) = 1;
          const RowVectorD above = z.row(r).cast<double>();
          const double gap = reference.energy(row, off, above) - reference.energy(row, on, above);
          CHECK(h[m](r, j) == doctest::Approx(1 / (1 + std::exp(-gap))).epsilon(1e-5));
        }
      const std::array<RowVectorD, 2> below = {h[0].row(r), h[1].row(r)};
      for (Eigen::Index j = 0; j < 2; ++j) {
        const double gap = reference.energy(row, below, RowVectorD::Zero(2)) -
                           reference.energy(row, below, RowVectorD::Unit(2, j));
        CHECK(joint(r, j) == doctest::Approx(1 / (1 + std::exp(-gap))).epsilon(1e-5));
      }
    }
    // The mean of v is where the energy is least.
    machine.infer_visible(0, units.hidden[0], units);
    const MatrixD mean =
        (h[0] * reference.W[0].transpose()).rowwise() + RowVectorD(reference.a[0].row(0));
    CHECK((units.visible[0].to_host().cast<double>() - mean).cwiseAbs().maxCoeff() < 1e-5);
  });
}

TEST_CASE("multimodal DBM: the energy's gradient is that of finite differences") {
  on_every_device([](Device& device) {
    const DbmMachine machine = some_machine(device);
    DbmMachine::Units units(device, kShape, 5);
    std::array<MatrixF, 2> v = {random_clip(5, 3, 1), random_clip(5, 2, 2)};
    std::array<MatrixF, 2> h = {random_clip(5, 3, 3).cwiseAbs(), random_clip(5, 2, 4).cwiseAbs()};
    const MatrixF z = random_clip(5, 2, 5).cwiseAbs();
    for (std::size_t m = 0; m < 2; ++m) {
      units.visible[m].upload(v[m]);
      units.hidden[m].upload(h[m]);
    }
    units.joint.upload(z);
    Matrix buffer = Matrix::like(machine.parameters().all());
    const Parameters gradients = machine.parameters().in(buffer);
    machine.add_energy_gradient(units, 0.2F, 0.0F, gradients);
    machine.add_energy_gradient(units, 0.3F, 1.0F, gradients);
    Reference reference = reference_of(machine.parameters());
    const auto energy = [&] {
      double sum = 0;
      for (Eigen::Index r = 0; r < 5; ++r)
        sum += reference.energy({v[0].row(r).cast<double>(), v[1].row(r).cast<double>()},
                                {h[0].row(r).cast<double>(), h[1].row(r).cast<double>()},
                                z.row(r).cast<double>());
      return 0.5 * sum;
    };
    const auto check = [&](const std::string& name, MatrixD& values, bool own) {
      CAPTURE(name);
      const MatrixF got = gradients.to_host(name);
      for (Eigen::Index i = 0; i < values.size(); ++i) {
        const double kept = values.data()[i], step = 1e-4;
        values.data()[i] = kept + step;
        const double up = energy();
        values.data()[i] = kept - step;
        const double down = energy();
        values.data()[i] = kept;
        // Of a's gradient the part that data and chains share is left out: 0.5 · 5 rows · a.
        const double slope = (up - down) / (2 * step) - (own ? 2.5 * kept : 0.0);
        CHECK(std::abs(static_cast<double>(got.data()[i]) - slope) < 1e-5);
      }
    };
    for (std::size_t m = 0; m < 2; ++m) {
      const std::string modality = m == 0 ? "_track" : "_pose";
      check("W" + modality, reference.W[m], false);
      check("U" + modality, reference.U[m], false);
      check("a" + modality, reference.a[m], true);
      check("b" + modality, reference.b[m], false);
    }
    check("c", reference.c, false);
  });
}

TEST_CASE("multimodal DBM: mean field is the reference's, one modality absent or none") {
  on_every_device([](Device& device) {
    const DbmMachine machine = some_machine(device);
    const Reference r = reference_of(machine.parameters());
    const std::array<MatrixF, 2> v = {random_clip(4, 3, 1), random_clip(4, 2, 2)};
    for (const std::size_t absent : {std::size_t{0}, std::size_t{1}, DbmMachine::kNoneAbsent}) {
      CAPTURE(absent);
      DbmMachine::Units units(device, kShape, 4);
      std::array<MatrixD, 2> visible, h;
      for (std::size_t m = 0; m < 2; ++m) {
        units.visible[m].upload(v[m]);
        visible[m] = m == absent ? MatrixD(r.a[m].replicate(4, 1)) : MatrixD(v[m].cast<double>());
      }
      machine.mean_field(units, absent, 3);
      MatrixD z = MatrixD::Zero(4, 2);
      const auto hidden = [&] {
        for (std::size_t m = 0; m < 2; ++m)
          h[m] = sigmoid((visible[m] * r.W[m] + z * r.U[m].transpose()).rowwise() +
                         RowVectorD(r.b[m].row(0)));
      };
      const auto joint = [&] {
        z = sigmoid((h[0] * r.U[0] + h[1] * r.U[1]).rowwise() + RowVectorD(r.c.row(0)));
      };
      const auto restore = [&] {
        if (absent < 2)
          visible[absent] =
              (h[absent] * r.W[absent].transpose()).rowwise() + RowVectorD(r.a[absent].row(0));
      };
      hidden();
      for (int step = 0; step < 3; ++step) {
        joint();
        restore();
        hidden();
      }
      joint();
      restore();
      for (std::size_t m = 0; m < 2; ++m) {
        CHECK((units.visible[m].to_host().cast<double>() - visible[m]).cwiseAbs().maxCoeff() <
              1e-5);
        CHECK((units.hidden[m].to_host().cast<double>() - h[m]).cwiseAbs().maxCoeff() < 1e-5);
      }
      CHECK((units.joint.to_host().cast<double>() - z).cwiseAbs().maxCoeff() < 1e-5);
    }
  });
}

TEST_CASE("multimodal DBM: a sweep draws h, then v and z from those, each by its own numbers") {
  on_every_device([](Device& device) {
    const DbmMachine machine = some_machine(device);
    const Reference r = reference_of(machine.parameters());
    DbmMachine::Units chains(device, kShape, 20);
    const std::array<MatrixF, 2> v = {random_clip(20, 3, 1), random_clip(20, 2, 2)};
    for (std::size_t m = 0; m < 2; ++m) chains.visible[m].upload(v[m]);
    const MatrixF z = (random_clip(20, 2, 3).array() > 0).cast<float>();
    chains.joint.upload(z);
    machine.gibbs_sweep(chains, {5, 6, 9, 40});
    const auto drawn = [](const MatrixD& probability, std::uint16_t phase) {
      return MatrixD(MatrixD::NullaryExpr(
          probability.rows(), probability.cols(), [&](Eigen::Index row, Eigen::Index column) {
            return static_cast<double>(random_uniform(
                       {5, 6, 9, phase}, static_cast<std::uint32_t>(row),
                       static_cast<std::uint32_t>(column))) < probability(row, column)
                       ? 1.0
                       : 0.0;
          }));
    };
    std::array<MatrixD, 2> h;
    for (std::size_t m = 0; m < 2; ++m) {
      h[m] = drawn(
          sigmoid((v[m].cast<double>() * r.W[m] + z.cast<double>() * r.U[m].transpose()).rowwise() +
                  RowVectorD(r.b[m].row(0))),
          static_cast<std::uint16_t>(40 + m));
      CHECK(chains.hidden_draws[m].to_host().cast<double>() == h[m]);
    }
    for (std::size_t m = 0; m < 2; ++m) {
      MatrixD want = (h[m] * r.W[m].transpose()).rowwise() + RowVectorD(r.a[m].row(0));
      for (Eigen::Index row = 0; row < want.rows(); ++row)
        for (Eigen::Index column = 0; column < want.cols(); ++column)
          want(row, column) +=
              random_normal({5, 6, 9, static_cast<std::uint16_t>(42 + m)},
                            static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column));
      CHECK((chains.visible[m].to_host().cast<double>() - want).cwiseAbs().maxCoeff() < 1e-4);
    }
    const MatrixD joint =
        sigmoid((h[0] * r.U[0] + h[1] * r.U[1]).rowwise() + RowVectorD(r.c.row(0)));
    CHECK(chains.joint.to_host().cast<double>() == drawn(joint, 44));
  });
}

TEST_CASE("multimodal DBM: chains reach the distribution that enumeration gives") {
  on_every_device([](Device& device) {
    const DbmMachine machine = some_machine(device);
    const Reference r = reference_of(machine.parameters());
    // v integrated out: a Gaussian's weight for each (h, z) is exp(½‖W·h‖² + a·W·h + b·h + …).
    double all = 0;
    RowVectorD h_mean = RowVectorD::Zero(5), z_mean = RowVectorD::Zero(2), v_mean(5);
    v_mean.setZero();
    double together = 0;  // E[h_0 · z_1], which shows that layers are coupled
    for (unsigned state = 0; state < 128; ++state) {
      const RowVectorD units = bits(state, 7), z = units.tail(2);
      double log_weight = r.c.row(0).dot(z);
      RowVectorD means(5);
      for (std::size_t m = 0; m < 2; ++m) {
        const RowVectorD h = m == 0 ? RowVectorD(units.head(3)) : RowVectorD(units.segment(3, 2));
        const RowVectorD drive = h * r.W[m].transpose();
        log_weight += 0.5 * drive.squaredNorm() + r.a[m].row(0).dot(drive) + r.b[m].row(0).dot(h) +
                      (h * r.U[m]).dot(z);
        (m == 0 ? means.head(3) : means.tail(2)) = drive + r.a[m].row(0);
      }
      const double weight = std::exp(log_weight);
      all += weight;
      h_mean += weight * units.head(5);
      z_mean += weight * z;
      v_mean += weight * means;
      together += weight * units(0) * z(1);
    }
    constexpr std::size_t kChains = 2000;
    constexpr int kSweeps = 60, kSettle = 20;
    DbmMachine::Units chains(device, kShape, kChains);
    RowVectorD h_got = RowVectorD::Zero(5), z_got = RowVectorD::Zero(2), v_got(5);
    v_got.setZero();
    double together_got = 0;
    for (std::uint32_t sweep = 0; sweep < kSweeps; ++sweep) {
      machine.gibbs_sweep(chains, {5, sweep, 9, 0});
      if (sweep < kSettle) continue;
      // h, and v and z given it, are a draw of all three.
      const MatrixD h0 = chains.hidden_draws[0].to_host().cast<double>();
      const MatrixD h1 = chains.hidden_draws[1].to_host().cast<double>();
      const MatrixD z = chains.joint.to_host().cast<double>();
      const double share = 1.0 / (kChains * (kSweeps - kSettle));
      h_got.head(3) += share * h0.colwise().sum();
      h_got.tail(2) += share * h1.colwise().sum();
      z_got += share * z.colwise().sum();
      v_got.head(3) += share * chains.visible[0].to_host().cast<double>().colwise().sum();
      v_got.tail(2) += share * chains.visible[1].to_host().cast<double>().colwise().sum();
      together_got += share * h0.col(0).dot(z.col(1));
    }
    // 80,000 draws, of which some ten sweeps in a chain are alike: 8000 that are independent,
    // deviations of at most 0.5 (h, z) and 2 (v), four of which are allowed.
    CHECK((h_got - h_mean / all).cwiseAbs().maxCoeff() < 4 * 0.5 / std::sqrt(8000));
    CHECK((z_got - z_mean / all).cwiseAbs().maxCoeff() < 4 * 0.5 / std::sqrt(8000));
    CHECK((v_got - v_mean / all).cwiseAbs().maxCoeff() < 4 * 2.0 / std::sqrt(8000));
    CHECK(std::abs(together_got - together / all) < 4 * 0.5 / std::sqrt(8000));
  });
}

}  // namespace dbm_machine_test
