"""Gaussian and binary (C)RBMs in PyTorch, learnt by CD-1 with momentum, as `mcdbn-cl fit` learns them."""

import time

import numpy
import torch

MOMENTUM, MOMENTUM_FROM_EPOCH, DECAY = 0.9, 5, 2e-4


class TorchCrbm:
    """W [visible x hidden], A [order visible x visible], B [order visible x hidden], a, b; oldest frame
    first. An order of 0 makes it an RBM."""

    def __init__(self, visible, hidden, order, binary, rates, seed, momentum=MOMENTUM, decay=DECAY):
        self.random = torch.Generator().manual_seed(seed)
        shapes = {"W": (visible, hidden), "a": (visible,), "b": (hidden,)}
        if order:
            shapes |= {"A": (order * visible, visible), "B": (order * visible, hidden)}
        self.parameters = {
            name: 0.01 * torch.randn(shape, generator=self.random) if name in "WAB" else torch.zeros(shape)
            for name, shape in shapes.items()}
        self.velocities = {name: torch.zeros(shape) for name, shape in shapes.items()}
        self.order, self.binary, self.rates = order, binary, rates
        self.momentum, self.decay = momentum, decay

    def step(self, data, history, momentum):
        p, n = self.parameters, len(data)
        bias_v, bias_h = p["a"], p["b"]
        if self.order:
            bias_v = torch.addmm(bias_v, history, p["A"])
            bias_h = torch.addmm(bias_h, history, p["B"])
        hidden_data = torch.sigmoid(torch.addmm(bias_h, data, p["W"]))
        drawn = (torch.rand(hidden_data.shape, generator=self.random) < hidden_data).float()
        visible = torch.addmm(bias_v, drawn, p["W"].t())
        if self.binary:
            visible = torch.sigmoid(visible)
        hidden = torch.sigmoid(torch.addmm(bias_h, visible, p["W"]))
        change_v, change_h = (data - visible) / n, (hidden_data - hidden) / n
        gradients = {"W": (data.t() @ hidden_data - visible.t() @ hidden) / n, "a": change_v.sum(0),
                     "b": change_h.sum(0)}
        if self.order:
            gradients |= {"A": history.t() @ change_v, "B": history.t() @ change_h}
        for name, gradient in gradients.items():
            if name in "WAB":
                gradient -= self.decay * p[name]
            self.velocities[name].mul_(momentum).add_(gradient, alpha=self.rates.get(name, self.rates["W"]))
            p[name] += self.velocities[name]

    @torch.no_grad()
    def fit(self, clips, batch, epochs):
        """@return seconds of each epoch"""
        frames = torch.tensor(numpy.vstack(clips), dtype=torch.float32)
        starts = numpy.cumsum([0] + [len(clip) for clip in clips])
        rows = torch.tensor([t for i, clip in enumerate(clips)
                             for t in range(starts[i] + self.order, starts[i] + len(clip))])
        window = torch.arange(-self.order, 0)
        seconds = []
        for epoch in range(epochs):
            start = time.perf_counter()
            shuffled = rows[torch.randperm(len(rows), generator=self.random)]
            for i in range(0, len(rows) - batch + 1, batch):
                at = shuffled[i:i + batch]
                history = frames[at[:, None] + window].view(len(at), -1) if self.order else None
                self.step(frames[at], history, self.momentum if epoch >= MOMENTUM_FROM_EPOCH else 0.0)
            seconds.append(time.perf_counter() - start)
        return seconds

    def letters(self):
        return {name: value.numpy() for name, value in self.parameters.items()}
