"""A binary RBM on scikit-learn's digits: mcdbn-cl and BernoulliRBM, epoch for epoch.

BernoulliRBM learns by persistent chains of drawn units, one for each row of a mini-batch, without momentum
or decay; so does mcdbn-cl here, then with means of visible units, then by plain CD-1. All are scored by the
estimator's own score_samples. The estimator has one thread or two, whichever is faster.
"""

import statistics
import time

import numpy
from program import Fitted
from sklearn.datasets import load_digits
from sklearn.neural_network import BernoulliRBM
from threadpoolctl import threadpool_limits

HIDDEN, EPOCHS = 100, 20
CASES = ((10, 0.05), (100, 0.1))  # size of a mini-batch, rate
PASSES = 50  # of score_samples, which turns one unit of a row in each
OURS = {"mcdbn-cl, persistent, visible units drawn": "--binary-persistent --binary-sample-visible",
        "mcdbn-cl, persistent": "--binary-persistent", "mcdbn-cl, CD-1": ""}
PEER = "scikit-learn"


def estimator(batch, rate, seed):
    return BernoulliRBM(n_components=HIDDEN, learning_rate=rate, batch_size=batch, n_iter=EPOCHS,
                        random_state=seed)


def pseudo_likelihood(W, a, b, data):
    """Of parameters with the paper's letters, by an estimator that has them."""
    machine = estimator(len(data), 0.1, 0)
    machine.set_params(n_iter=1).fit(data[:2])
    machine.components_, machine.intercept_visible_, machine.intercept_hidden_ = W.T, a, b
    machine.random_state = numpy.random.RandomState(0)  # the same units are turned for all
    return statistics.mean(machine.score_samples(data).mean() for _ in range(PASSES))


def by_estimator(data, batch, rate, seed):
    walls = []
    for threads in (1, 2):  # such small products are often faster by one
        machine = estimator(batch, rate, seed)
        with threadpool_limits(threads):
            start = time.perf_counter()
            machine.fit(data)
            walls.append(time.perf_counter() - start)
    wall = min(walls)
    score = pseudo_likelihood(machine.components_.T, machine.intercept_visible_,
                              machine.intercept_hidden_, data)
    return {"score": score, "epoch_ms": 1e3 * wall / EPOCHS, "wall_s": wall}


def by_program(data, batch, rate, seed, how, cli):
    fitted = Fitted([data], "rbm",
                    f"--hidden {HIDDEN} --batch {batch} --seed {seed} --binary-epochs {EPOCHS} --binary-rate "
                    f"{rate} --binary-gibbs-steps 1 --binary-momentum 0 --binary-weight-decay 0 "
                    f"--binary-initial-deviation 0.01 {how}", cli)
    letters = [fitted.parameters[name].astype(numpy.float64) for name in "Wab"]
    return {"score": pseudo_likelihood(letters[0], letters[1].ravel(), letters[2].ravel(), data),
            "own_score": fitted.score(data)["pseudo_log_likelihood"],
            "epoch_ms": statistics.median(1e3 * len(data) / rate for rate in fitted.windows_per_s),
            "wall_s": fitted.wall_s}


def compare(rounds, cli):
    data = load_digits().data / 16
    print(f"\n### Binary RBM on digits: {len(data)} x {data.shape[1]}, {HIDDEN} hidden, {EPOCHS} epochs\n")
    print("| mini-batch, rate | | pseudo-likelihood by scikit-learn | by `score` | an epoch, ms | all, s "
          "| scikit-learn's epoch takes |\n|---|---|---|---|---|---|---|")
    for batch, rate in CASES:
        runs = {}
        for seed in range(1, rounds + 1):
            runs.setdefault(PEER, []).append(by_estimator(data, batch, rate, seed))
            for name, how in OURS.items():
                runs.setdefault(name, []).append(by_program(data, batch, rate, seed, how, cli))
        peer_ms = statistics.median(run["epoch_ms"] for run in runs[PEER])
        for name, results in runs.items():
            median = {key: statistics.median(r[key] for r in results) for key in results[0]}
            own = f"{median['own_score']:.2f}" if "own_score" in median else ""
            print(f"| {batch}, {rate} | {name} | {median['score']:.2f} | {own} | {median['epoch_ms']:.1f} "
                  f"| {median['wall_s']:.2f} | {peer_ms / median['epoch_ms']:.1f} times as long |",
                  flush=True)
