#include <doctest/doctest.h>

#include <random>

#include "mcdbn/base/random.hpp"
#include "reference/crbm_enumeration.hpp"
#include "reference/crbm_reference.hpp"
#include "reference/finite_difference.hpp"
#include "reference/mrbm_reference.hpp"

using namespace mcdbn;
using namespace mcdbn::reference;

namespace {

MatrixD normal_matrix(Eigen::Index rows, Eigen::Index columns, double scale,
                      std::mt19937& generator) {
  std::normal_distribution<double> normal(0.0, scale);
  return MatrixD::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

MatrixD probabilities(Eigen::Index rows, Eigen::Index columns, std::mt19937& generator) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return MatrixD::NullaryExpr(rows, columns, [&] { return uniform(generator); });
}

Crbm tiny_crbm(VisibleUnits kind, Eigen::Index order, double scale, std::mt19937& generator) {
  const Eigen::Index visible = 4;
  const Eigen::Index hidden = 3;
  Crbm model;
  model.visible_units = kind;
  model.weights = normal_matrix(visible, hidden, scale, generator);
  model.visible_history = normal_matrix(order * visible, visible, 0.3 * scale, generator);
  model.hidden_history = normal_matrix(order * visible, hidden, 0.3 * scale, generator);
  model.visible_bias = normal_matrix(1, visible, scale, generator);
  model.hidden_bias = normal_matrix(1, hidden, scale, generator);
  return model;
}

CrbmBatch tiny_batch(const Crbm& model, Eigen::Index rows, std::mt19937& generator) {
  const Eigen::Index visible = model.weights.rows();
  const Eigen::Index history = model.visible_history.rows();
  if (model.visible_units == VisibleUnits::gaussian)
    return {normal_matrix(rows, visible, 1.0, generator),
            normal_matrix(rows, history, 1.0, generator)};
  const auto bits = [&](Eigen::Index columns) -> MatrixD {
    return (probabilities(rows, columns, generator).array() < 0.5).cast<double>();
  };
  return {bits(visible), bits(history)};
}

/// Eight cases, each `copies` times over, so that chains of one case average out.
CrbmBatch repeated(const CrbmBatch& batch, Eigen::Index copies) {
  return {batch.visible.replicate(copies, 1), batch.history.replicate(copies, 1)};
}

double cosine(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  return x.dot(y) / (x.norm() * y.norm());
}

}  // namespace

TEST_CASE("reference: the exact CRBM gradient is that of the enumerated likelihood") {
  std::mt19937 generator(1);
  for (const auto kind : {VisibleUnits::gaussian, VisibleUnits::binary})
    for (const Eigen::Index order : {0, 2}) {
      CAPTURE(order);
      const Crbm model = tiny_crbm(kind, order, 0.5, generator);
      const CrbmBatch batch = tiny_batch(model, 5, generator);
      const Eigen::VectorXd numeric = finite_difference(
          [&](const Eigen::VectorXd& x) { return log_likelihood(model.with_parameters(x), batch); },
          model.flattened());
      const Eigen::VectorXd analytic = exact_gradient(model, batch).flattened();
      CHECK(analytic.norm() > 0.1);
      CHECK((analytic - numeric).cwiseAbs().maxCoeff() < 1e-8);
    }
}

TEST_CASE("reference: the enumerated likelihood of a binary RBM sums to one") {
  std::mt19937 generator(2);
  const Crbm model = tiny_crbm(VisibleUnits::binary, 0, 1.0, generator);
  double total = 0;
  for (int state = 0; state < 16; ++state) {
    CrbmBatch one{MatrixD(1, 4), MatrixD(1, 0)};
    for (int i = 0; i < 4; ++i) one.visible(0, i) = (state >> i) & 1;
    total += std::exp(log_likelihood(model, one));
  }
  CHECK(std::abs(total - 1.0) < 1e-12);
}

TEST_CASE("reference: with many Gibbs steps CD points where the likelihood rises") {
  std::mt19937 generator(3);
  for (const auto kind : {VisibleUnits::gaussian, VisibleUnits::binary})
    for (const Eigen::Index order : {0, 2}) {
      const bool gaussian = kind == VisibleUnits::gaussian;
      CAPTURE(gaussian);
      CAPTURE(order);
      const Crbm model = tiny_crbm(kind, order, 0.3, generator);
      const CrbmBatch cases = tiny_batch(model, 8, generator);
      const CrbmBatch batch = repeated(cases, 500);
      const HiddenDraws draws = [&](int step) {
        RandomKey key{.seed = 7, .step = static_cast<std::uint32_t>(step)};
        MatrixD uniform(batch.visible.rows(), model.hidden_bias.size());
        for (Eigen::Index r = 0; r < uniform.rows(); ++r)
          for (Eigen::Index j = 0; j < uniform.cols(); ++j)
            uniform(r, j) =
                random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(j));
        return uniform;
      };
      const Eigen::VectorXd cd =
          contrastive_divergence(model, batch, 50, draws).gradient.flattened();
      const Eigen::VectorXd exact = exact_gradient(model, cases).flattened();
      // Visible units are means rather than samples, so the two do not coincide.
      CHECK(cosine(cd, exact) > 0.95);
      const Eigen::VectorXd uphill = model.flattened() + 0.05 * cd;
      CHECK(log_likelihood(model.with_parameters(uphill), cases) > log_likelihood(model, cases));
    }
}

TEST_CASE("reference: the multi-prediction gradient is that of its loss") {
  std::mt19937 generator(4);
  Mrbm model;
  model.weights = {normal_matrix(4, 3, 0.7, generator), normal_matrix(5, 3, 0.7, generator)};
  model.visible_bias = {normal_matrix(1, 4, 0.5, generator), normal_matrix(1, 5, 0.5, generator)};
  model.hidden_bias = normal_matrix(1, 3, 0.5, generator);
  const std::vector<MatrixD> batch{probabilities(6, 4, generator), probabilities(6, 5, generator)};
  for (const int steps : {1, 2, 5, 10}) {
    CAPTURE(steps);
    const auto loss = [&](const Eigen::VectorXd& x) {
      return multi_prediction(model.with_parameters(x), batch, steps).loss;
    };
    const Eigen::VectorXd numeric = finite_difference(loss, model.flattened());
    const Eigen::VectorXd analytic = multi_prediction(model, batch, steps).gradient.flattened();
    CHECK(analytic.norm() > 0.1);
    CHECK((analytic - numeric).cwiseAbs().maxCoeff() < 1e-8);
  }
}

TEST_CASE("reference: mean field starts from zeros and settles") {
  std::mt19937 generator(5);
  Mrbm model;
  model.weights = {normal_matrix(4, 3, 0.5, generator), normal_matrix(5, 3, 0.5, generator)};
  model.visible_bias = {normal_matrix(1, 4, 0.5, generator), normal_matrix(1, 5, 0.5, generator)};
  model.hidden_bias = normal_matrix(1, 3, 0.5, generator);
  const MatrixD present = probabilities(2, 4, generator);
  const MeanFieldTrace trace = mean_field(model, 1, {present, {}}, 100);
  CHECK(trace.missing.front().isZero(0.0));
  CHECK((trace.missing.back() - trace.missing[99]).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((trace.missing.back() - trace.missing[1]).cwiseAbs().maxCoeff() > 1e-3);
}
