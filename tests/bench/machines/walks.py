"""A Gaussian CRBM of Taylor's size on CMU walks: mcdbn-cl and PyTorch, the same learning of both.

Both machines' parameters are judged by the same code on people that were not trained on: the frame that
follows a true history, and 300 frames that follow a clip's beginning, each on the last ones' heels.
"""

import statistics

import numpy
import torch
from program import Fitted
from torch_crbm import TorchCrbm
from walk_data import Walks

HIDDEN, ORDER, BATCH, EPOCHS = 200, 6, 100, 150
RATE, RATE_A = 1e-3, 1e-5
STEPS = 30  # between a frame's units, from the last frame on
FRAMES, SEED_FRAME = 300, 30  # generated, and where in a clip


def sigmoid(x):
    return 1 / (1 + numpy.exp(-x))


def next_frame(p, history, visible, random=None):
    """Frames that follow histories [rows x order visible], from the last ones; drawn hidden units if
    `random` is there, else mean field."""
    bias_v, bias_h = p["a"] + history @ p["A"], p["b"] + history @ p["B"]
    for step in range(STEPS):
        hidden = sigmoid(bias_h + visible @ p["W"])
        if random is not None and step + 1 < STEPS:
            hidden = (random.random(hidden.shape) < hidden).astype(numpy.float32)
        visible = bias_v + hidden @ p["W"].T
    return visible


def one_step(p, clips):
    """(reconstruction, prediction of the next frame, the last frame again): root mean squared errors in
    the features' deviations."""
    rebuilt, predicted, held = [], [], []
    for clip in clips:
        windows = numpy.stack([clip[i:len(clip) - ORDER + i] for i in range(ORDER)], 1)
        history, now = windows.reshape(len(windows), -1), clip[ORDER:]
        hidden = sigmoid(p["b"] + history @ p["B"] + now @ p["W"])
        rebuilt.append(now - (p["a"] + history @ p["A"] + hidden @ p["W"].T))
        predicted.append(now - next_frame(p, history, windows[:, -1]))
        held.append(now - windows[:, -1])
    return [float(numpy.sqrt((numpy.vstack(errors) ** 2).mean())) for errors in (rebuilt, predicted, held)]


def generated(p, clips, random):
    """[clips x FRAMES x features], each going on from its clip's frame SEED_FRAME."""
    frames = [numpy.stack([clip[SEED_FRAME - ORDER + i] for clip in clips]) for i in range(ORDER)]
    for _ in range(FRAMES):
        history = numpy.hstack(frames[-ORDER:])
        frames.append(next_frame(p, history, frames[-1], random))
    return numpy.stack(frames[ORDER:], 1)


def generation(p, clips, seed, walks):
    """Errors of the first frames and how far each feature deviates, as a share of training's."""
    clips = [clip for clip in clips if len(clip) >= SEED_FRAME + 30]
    new = generated(p, clips, numpy.random.RandomState(seed))
    truth = numpy.stack([clip[SEED_FRAME:SEED_FRAME + 30] for clip in clips])
    error = [float(numpy.sqrt(((new[:, :n] - truth[:, :n]) ** 2).mean())) for n in (10, 30)]
    spread = numpy.array([clip.std(0) for clip in walks.training]).mean(0)  # within a clip
    shares = numpy.array([clip.std(0) for clip in new[:, 100:]]).mean(0) / spread
    shares = shares[numpy.isfinite(shares)]
    return {"error_10": error[0], "error_30": error[1], "spread_median": float(numpy.median(shares)),
            "spread_low": float(numpy.quantile(shares, 0.1)),
            "spread_high": float(numpy.quantile(shares, 0.9)),
            "alive": float(((shares > 0.5) & (shares < 1.5)).mean())}


def judged(parameters, epoch_s, wall_s, walks, seed):
    p = {name: value.astype(numpy.float64).reshape(-1) if name in "ab" else value.astype(numpy.float64)
         for name, value in parameters.items()}
    rebuilt, predicted, held = one_step(p, walks.test)
    return {"epoch_ms": 1e3 * statistics.median(epoch_s), "wall_s": wall_s, "rebuilt": rebuilt,
            "predicted": predicted, "held": held, **generation(p, walks.test, seed, walks)}


def by_program(walks, seed, cli):
    fitted = Fitted(walks.training, "crbm",
                    f"--hidden {HIDDEN} --order {ORDER} --batch {BATCH} --gaussian-epochs {EPOCHS} "
                    f"--gaussian-gibbs-steps 1 --gaussian-rate {RATE} --gaussian-rate-B {RATE} "
                    f"--gaussian-rate-A {RATE_A} --seed {seed}", cli)
    windows = sum(len(clip) - ORDER for clip in walks.training)
    p = {name: fitted.parameters[name] for name in "WABab"}
    return judged(p, [windows / rate for rate in fitted.windows_per_s], fitted.wall_s, walks, seed)


def by_pytorch(walks, seed):
    machine = TorchCrbm(walks.training[0].shape[1], HIDDEN, ORDER, False, {"W": RATE, "A": RATE_A}, seed)
    seconds = machine.fit(walks.training, BATCH, EPOCHS)
    return judged(machine.letters(), seconds, sum(seconds), walks, seed)


def compare(rounds, cli, folder):
    if not folder.is_dir():
        print(f"\nSKIPPED walks: no folder {folder}")
        return
    torch.set_num_threads(2)
    walks = Walks(folder)
    print(f"\n### Gaussian CRBM on CMU walks: {sum(map(len, walks.training))} frames of "
          f"{walks.training[0].shape[1]} features, {HIDDEN} hidden, order {ORDER}, CD-1, mini-batches of "
          f"{BATCH}, {EPOCHS} epochs\n")
    runs = {"PyTorch": [], "mcdbn-cl": []}
    for seed in range(1, rounds + 1):
        runs["PyTorch"].append(by_pytorch(walks, seed))
        runs["mcdbn-cl"].append(by_program(walks, seed, cli))
    median = {name: {key: statistics.median(r[key] for r in results) for key in results[0]}
              for name, results in runs.items()}
    print("| | " + " | ".join(median) + " |\n|---|---|---|")
    rows = {"an epoch, ms": ("epoch_ms", ".1f"), "all, s": ("wall_s", ".2f"),
            "reconstruction, RMS": ("rebuilt", ".3f"), "next frame, RMS": ("predicted", ".3f"),
            "the last frame again, RMS": ("held", ".3f"), "10 generated frames, RMS": ("error_10", ".3f"),
            "30 generated frames, RMS": ("error_30", ".3f"),
            "deviation of 200 later ones, share of training's, median": ("spread_median", ".2f"),
            "the same, a tenth of the features is below": ("spread_low", ".2f"),
            "the same, a tenth is above": ("spread_high", ".2f"),
            "features between 0.5 and 1.5": ("alive", ".0%")}
    for title, (key, style) in rows.items():
        print(f"| {title} | " + " | ".join(format(of[key], style) for of in median.values()) + " |")
    share = median["PyTorch"]["epoch_ms"] / median["mcdbn-cl"]["epoch_ms"]
    print(f"\nPyTorch's epoch takes {share:.1f} times as long.", flush=True)
