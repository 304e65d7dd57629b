"""A binary RBM of MNIST's size, 784 units and 500 hidden, by CD-1: mcdbn-cl, PyTorch and learnergy.

The data are scikit-learn's digits, enlarged from 8 x 8 to 28 x 28 pixels.
"""

import logging
import statistics
import time

import numpy
import torch
from learnergy.models.bernoulli import RBM
from program import Fitted
from scipy.ndimage import zoom
from sklearn.datasets import load_digits
from torch_crbm import TorchCrbm

HIDDEN, BATCH, EPOCHS, RATE = 500, 100, 10, 0.05


def large_digits():
    images = load_digits().images / 16
    return zoom(images, (1, 3.5, 3.5), order=1).clip(0, 1).reshape(len(images), -1)


def reconstruction_error(p, data):
    """Mean squared error of one way up and down by mean field."""
    hidden = 1 / (1 + numpy.exp(-(data @ p["W"] + p["b"].reshape(-1))))
    again = 1 / (1 + numpy.exp(-(hidden @ p["W"].T + p["a"].reshape(-1))))
    return float(((data - again) ** 2).mean())


def by_learnergy(data, seed):
    logging.disable(logging.CRITICAL)
    torch.manual_seed(seed)
    machine = RBM(n_visible=data.shape[1], n_hidden=HIDDEN, steps=1, learning_rate=RATE, momentum=0, decay=0,
                  temperature=1, use_gpu=False)
    units = torch.tensor(data, dtype=torch.float32)
    rows = torch.utils.data.TensorDataset(units, torch.zeros(len(units)))
    start = time.perf_counter()
    machine.fit(rows, batch_size=BATCH, epochs=EPOCHS)
    wall = time.perf_counter() - start
    letters = {"W": machine.W, "a": machine.a, "b": machine.b}
    p = {name: value.detach().numpy() for name, value in letters.items()}
    return wall / EPOCHS, wall, reconstruction_error(p, data)


def compare(rounds, cli):
    torch.set_num_threads(2)
    data = large_digits()
    runs = {"PyTorch": [], "learnergy": [], "mcdbn-cl": []}
    for seed in range(1, rounds + 1):
        machine = TorchCrbm(data.shape[1], HIDDEN, 0, True, {"W": RATE}, seed, 0.0, 0.0)
        seconds = machine.fit([data], BATCH, EPOCHS)
        runs["PyTorch"].append((statistics.median(seconds), sum(seconds),
                                reconstruction_error(machine.letters(), data)))
        runs["learnergy"].append(by_learnergy(data, seed))
        fitted = Fitted([data], "rbm",
                        f"--hidden {HIDDEN} --batch {BATCH} --seed {seed} --binary-epochs {EPOCHS} "
                        f"--binary-rate {RATE} --binary-gibbs-steps 1 --binary-momentum 0 "
                        "--binary-weight-decay 0 --binary-initial-deviation 0.01", cli)
        runs["mcdbn-cl"].append((statistics.median(len(data) / rate for rate in fitted.windows_per_s),
                                 fitted.wall_s, reconstruction_error(fitted.parameters, data)))
    print(f"\n### Binary RBM: {len(data)} x {data.shape[1]}, {HIDDEN} hidden, CD-1, mini-batches of {BATCH}, "
          f"{EPOCHS} epochs\n\n| | an epoch, ms | all, s | squared error of reconstruction |\n"
          "|---|---|---|---|")
    medians = {name: [statistics.median(column) for column in zip(*results)]
               for name, results in runs.items()}
    for name, (epoch, wall, error) in medians.items():
        print(f"| {name} | {1e3 * epoch:.1f} | {wall:.2f} | {error:.5f} |")
    for name in ("PyTorch", "learnergy"):
        print(f"\n{name}'s epoch takes {medians[name][0] / medians['mcdbn-cl'][0]:.1f} times as long.",
              flush=True)
