"""The mini-batch steps of `mcdbn-cl bench` in PyTorch, on the CPU.

    python pytorch_peer.py LAYER BATCH SECONDS

prints {} when it is ready, then {"variant": median_us, ...} for each line of its input: eager with
torch.bernoulli and with rand < p, compiled with rand < p. The variants take turns, so that whatever
else the machine does slows all of them. Layers: gaussian_crbm,
binary_crbm, persistent_gaussian_crbm, joint_likelihood, mrbm (of two modalities), mrbm_3 (of three),
fine_tuning (BATCH is then the number of windows), and regeneration, generation_1 and generation_30
(BATCH is then the number of samples, the number that of drawn steps a frame). Of a generation's 1,000
frames, all of the same work, 50 are run at a time: 30 steps take minutes otherwise.
"""

import json
import statistics
import sys
import time

import torch

ORDER, HIDDEN = 5, 300
RATE, RATE_A, MOMENTUM, DECAY = 1e-3, 1e-5, 0.9, 2e-4


def bernoulli(p):
    return torch.bernoulli(p)


def compare(p):
    return (torch.rand_like(p) < p).to(p.dtype)


DRAWS = {"bernoulli": bernoulli, "rand < p": compare}


def normal(*shape, scale=0.01):
    return scale * torch.randn(*shape)


def frames_of(visible, binary):
    frames = torch.randn(4096, visible)
    return (0.5 + 0.2 * frames).clamp(0, 1) if binary else frames


def momentum_update(parameter, velocity, gradient, rate, decay):
    velocity.mul_(MOMENTUM).add_(gradient - decay * parameter if decay else gradient, alpha=rate)
    parameter.add_(velocity)


class CrbmStep:
    """CD-k as kernels/contrastive_divergence.cl and contrastive_divergence_update.cl do it."""

    def __init__(self, visible, batch, gibbs_steps, binary, draw, persistent=False):
        self.particles = draw(torch.full((batch, HIDDEN), 0.5)) if persistent else None
        self.frames = frames_of(visible, binary)
        self.rows = torch.randint(ORDER, 4096, (batch,))
        self.window = torch.arange(-ORDER, 0)
        shapes = {"W": (visible, HIDDEN), "A": (ORDER * visible, visible),
                  "B": (ORDER * visible, HIDDEN), "a": (visible,), "b": (HIDDEN,)}
        self.parameters = {name: normal(*shape) for name, shape in shapes.items()}
        self.velocities = {name: torch.zeros(*shape) for name, shape in shapes.items()}
        self.gibbs_steps, self.binary, self.draw = gibbs_steps, binary, draw
        self.loss = torch.zeros(())

    def __call__(self):
        p, n = self.parameters, len(self.rows)
        data = self.frames[self.rows]
        history = self.frames[self.rows[:, None] + self.window].view(n, -1)
        bias_v = torch.addmm(p["a"], history, p["A"])
        bias_h = torch.addmm(p["b"], history, p["B"])
        hidden_data = torch.sigmoid(torch.addmm(bias_h, data, p["W"]))
        sample = self.draw(hidden_data) if self.particles is None else self.particles
        for step in range(self.gibbs_steps):
            if step > 0:
                sample = self.draw(hidden)
            visible = torch.addmm(bias_v, sample, p["W"].t())
            if self.binary:
                visible = torch.sigmoid(visible)
            hidden = torch.sigmoid(torch.addmm(bias_h, visible, p["W"]))
        if self.particles is not None:
            self.particles.copy_(self.draw(hidden))
        change_v, change_h = (data - visible) / n, (hidden_data - hidden) / n
        gradients = {"W": (data.t() @ hidden_data - visible.t() @ hidden) / n,
                     "A": history.t() @ change_v, "B": history.t() @ change_h,
                     "a": change_v.sum(0), "b": change_h.sum(0)}
        self.loss += (data - visible).square().mean()
        for name, gradient in gradients.items():
            momentum_update(p[name], self.velocities[name], gradient,
                            RATE_A if name == "A" else RATE, DECAY if name in "WAB" else 0)


class MrbmStep:
    """Multi-prediction through ten mean-field steps, by autograd, with Adam."""

    STEPS = 10

    def __init__(self, batch, modalities, fused, visible=300, hidden=150):
        self.frames = [frames_of(visible, True) for _ in range(modalities)]
        self.rows = torch.randint(0, 4096, (batch,))
        self.W = [normal(visible, hidden).requires_grad_() for _ in range(modalities)]
        self.a = [torch.zeros(visible, requires_grad=True) for _ in range(modalities)]
        self.b = torch.zeros(hidden, requires_grad=True)
        self.optimizer = torch.optim.Adam([*self.W, *self.a, self.b], lr=1e-3, fused=fused)
        self.total = torch.zeros(())

    def loss(self):
        codes = [frames[self.rows] for frames in self.frames]
        total = 0.0
        for absent in range(len(codes)):
            drive = self.b
            for present in range(len(codes)):
                if present != absent:
                    drive = torch.addmm(drive, codes[present], self.W[present])
            hidden = torch.sigmoid(drive)
            for step in range(self.STEPS):
                logits = torch.addmm(self.a[absent], hidden, self.W[absent].t())
                if step + 1 < self.STEPS:
                    hidden = torch.sigmoid(
                        torch.addmm(drive, torch.sigmoid(logits), self.W[absent]))
            total = total + torch.nn.functional.binary_cross_entropy_with_logits(
                logits, codes[absent], reduction="sum") / len(self.rows)
        return total

    def __call__(self):
        self.optimizer.zero_grad(set_to_none=True)
        loss = self.loss()
        loss.backward()
        self.optimizer.step()
        self.total += loss.detach()


class JointLikelihoodStep:
    """CD-1 over both binary modalities at once, with Adam. Such an MRBM is an RBM whose visible units
    are those of both: here they are one matrix, which suits PyTorch best."""

    def __init__(self, batch, draw, fused, visible=600, hidden=150):
        self.frames = frames_of(visible, True)
        self.rows = torch.randint(0, 4096, (batch,))
        self.W, self.a, self.b = normal(visible, hidden), torch.zeros(visible), torch.zeros(hidden)
        self.optimizer = torch.optim.Adam([self.W, self.a, self.b], lr=1e-3, fused=fused)
        self.draw = draw
        self.losses = torch.zeros(2)

    def gradients(self):
        data, n = self.frames[self.rows], len(self.rows)
        hidden_data = torch.sigmoid(torch.addmm(self.b, data, self.W))
        visible = torch.sigmoid(torch.addmm(self.a, self.draw(hidden_data), self.W.t()))
        hidden = torch.sigmoid(torch.addmm(self.b, visible, self.W))
        change = visible - data
        self.losses += change.square().view(n, 2, -1).mean((0, 2))
        return ((visible.t() @ hidden - data.t() @ hidden_data) / n, change.mean(0),
                (hidden - hidden_data).mean(0))

    def __call__(self):
        self.W.grad, self.a.grad, self.b.grad = self.gradients()
        self.optimizer.step()


class FineTuningStep:
    """A mini-batch of fine-tuning in both directions: up-pass, two mean-field steps from zeros, down-pass
    on its own output, squared errors, autograd; Adam with weight decay, a limit of the gradient's
    length, a moving average of the parameters. Frames without a history have no code to compute."""

    SIZES, ORDER, HIDDEN, SHARED, SETTLE, JUDGED = (43, 154), 10, 768, 512, 4, 20

    def __init__(self, windows, fused):
        self.frames = self.ORDER + self.SETTLE + self.JUDGED
        self.data = [torch.randn(windows, self.frames, size) for size in self.SIZES]
        weights, biases = {}, {"b": torch.zeros(self.SHARED)}
        for m, size in enumerate(self.SIZES):
            weights |= {f"W{m}": normal(size, self.HIDDEN), f"A{m}": normal(self.ORDER * size, size),
                        f"B{m}": normal(self.ORDER * size, self.HIDDEN),
                        f"M{m}": normal(self.HIDDEN, self.SHARED)}
            biases |= {f"a{m}": torch.zeros(size), f"b{m}": torch.zeros(self.HIDDEN),
                       f"c{m}": torch.zeros(self.HIDDEN)}
        self.p = {name: p.requires_grad_() for name, p in (weights | biases).items()}
        self.optimizer = torch.optim.AdamW(
            [{"params": list(weights.values()), "weight_decay": 1.0},
             {"params": list(biases.values()), "weight_decay": 0.0}],
            lr=1e-3, betas=(0.9, 0.99), fused=fused)
        self.averages = [p.detach().clone() for p in self.p.values()]
        self.total = torch.zeros(())

    def predicted(self, present, absent):
        p, x, first = self.p, self.data[present], self.ORDER
        history = x.unfold(1, self.ORDER, 1)[:, :-1].transpose(2, 3).flatten(2)
        code = torch.sigmoid(x[:, first:] @ p[f"W{present}"] + history @ p[f"B{present}"]
                             + p[f"b{present}"])
        drive = code @ p[f"M{present}"] + p["b"]
        v = torch.sigmoid(torch.sigmoid(drive) @ p[f"M{absent}"].t() + p[f"c{absent}"])
        h = torch.sigmoid(drive + v @ p[f"M{absent}"])
        v = torch.sigmoid(h @ p[f"M{absent}"].t() + p[f"c{absent}"])
        above = v @ p[f"W{absent}"].t() + p[f"a{absent}"]
        past = torch.zeros(len(x), self.ORDER * self.SIZES[absent])
        frames = []
        for t in range(above.shape[1]):
            frames.append(torch.addmm(above[:, t], past, p[f"A{absent}"]))
            past = torch.cat([past[:, self.SIZES[absent]:], frames[-1]], 1)
        return torch.stack(frames[self.SETTLE:], 1)

    def loss(self):
        judged = self.ORDER + self.SETTLE
        return sum(weight * torch.nn.functional.mse_loss(self.predicted(present, absent),
                                                         self.data[absent][:, judged:])
                   for present, absent, weight in ((0, 1, 1.0), (1, 0, 0.4)))

    def __call__(self):
        self.optimizer.zero_grad(set_to_none=True)
        loss = self.loss()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.p.values(), 1.0)
        self.optimizer.step()
        with torch.no_grad():
            torch._foreach_lerp_(self.averages, list(self.p.values()), 0.005)
            self.total += loss


class Generation:
    """Frames of a Gaussian CRBM on its own output, `samples` at a time (Algorithm 4)."""

    FRAMES, VISIBLE = 50, 96
    TIMES = 1000 // FRAMES

    def __init__(self, samples, gibbs_steps, draw):
        shapes = {"W": (self.VISIBLE, HIDDEN), "A": (ORDER * self.VISIBLE, self.VISIBLE),
                  "B": (ORDER * self.VISIBLE, HIDDEN)}
        self.parameters = {name: normal(*shape) for name, shape in shapes.items()}
        self.a, self.b = torch.zeros(self.VISIBLE), torch.zeros(HIDDEN)
        self.seed = torch.randn(ORDER, self.VISIBLE).flatten().repeat(samples, 1)
        self.gibbs_steps, self.draw = gibbs_steps, draw

    def next_frame(self, history):
        p = self.parameters
        bias_v = torch.addmm(self.a, history, p["A"])
        bias_h = torch.addmm(self.b, history, p["B"])
        visible = history[:, -self.VISIBLE:]
        for step in range(self.gibbs_steps + 1):
            hidden = torch.sigmoid(torch.addmm(bias_h, visible, p["W"]))
            if step < self.gibbs_steps:
                hidden = self.draw(hidden)
            visible = torch.addmm(bias_v, hidden, p["W"].t())
        return visible, torch.cat([history[:, self.VISIBLE:], visible], 1)

    def __call__(self):
        history, frames = self.seed, []
        for _ in range(self.FRAMES):
            frame, history = self.next_frame(history)
            frames.append(frame)
        return torch.stack(frames, 1)


class Regeneration:
    """A 1,000-frame clip, `samples` times: up-pass, mean field, sampled down-pass (Algorithm 5)."""

    FRAMES, TRACK, POSE, GIBBS_STEPS, AHEAD, RUN_IN = 1000, 43, 96, 3, 5, 30

    def __init__(self, samples, draw):
        def layers(visible):
            return [{"W": normal(v, HIDDEN), "A": normal(ORDER * v, v), "B": normal(ORDER * v, HIDDEN),
                     "a": torch.zeros(v), "b": torch.zeros(HIDDEN)} for v in (visible, HIDDEN)]
        self.samples, self.draw = samples, draw
        self.track, self.pose = layers(self.TRACK), layers(self.POSE)
        self.W = [normal(HIDDEN, HIDDEN) for _ in range(2)]
        self.a, self.b = torch.zeros(HIDDEN), torch.zeros(HIDDEN)
        lead = 2 * ORDER + self.RUN_IN
        clip = torch.randn(self.FRAMES, self.TRACK)
        self.clip = torch.cat([clip[:1].expand(lead, -1), clip, clip[-1:].expand(self.AHEAD, -1)])

    def up(self, layer, x):
        windows = x.unfold(1, ORDER, 1)[:, :-1].transpose(2, 3).flatten(2)
        return torch.sigmoid(windows @ layer["B"] + x[:, ORDER:] @ layer["W"] + layer["b"])

    @torch.no_grad()
    def __call__(self):
        code = self.clip[None]  # the samples differ in the down-pass only
        for layer in self.track:
            code = self.up(layer, code)
        drive = code[:, self.AHEAD:] @ self.W[0] + self.b
        hidden = torch.sigmoid(drive)
        for step in range(5):
            pose_code = torch.sigmoid(hidden @ self.W[1].t() + self.a)
            hidden = torch.sigmoid(drive + pose_code @ self.W[1])
        pose_code = pose_code.expand(self.samples, -1, -1)
        low, top = self.pose
        history_top = torch.zeros(self.samples, ORDER, HIDDEN)
        history_low = torch.zeros(self.samples, ORDER, self.POSE)
        frames = []
        for t in range(pose_code.shape[1]):
            bias_v = torch.addmm(top["a"], history_top.flatten(1), top["A"])
            bias_h = torch.addmm(top["b"], history_top.flatten(1), top["B"])
            above = pose_code[:, t]
            for _ in range(self.GIBBS_STEPS):
                below = self.draw(torch.sigmoid(torch.addmm(bias_v, above, top["W"].t())))
                above = self.draw(torch.sigmoid(torch.addmm(bias_h, below, top["W"])))
            below = torch.sigmoid(torch.addmm(bias_v, above, top["W"].t()))
            frame = torch.addmm(torch.addmm(low["a"], history_low.flatten(1), low["A"]), below,
                                low["W"].t())
            history_top = torch.cat([history_top[:, 1:], below[:, None]], 1)
            history_low = torch.cat([history_low[:, 1:], frame[:, None]], 1)
            frames.append(frame)
        return torch.stack(frames, 1)


def makers(layer, batch):
    """(variant, function that makes the step, its method that is worth compiling)"""
    if layer.startswith("mrbm"):
        modalities = 3 if layer == "mrbm_3" else 2
        return [(name, lambda fused=fused: MrbmStep(batch, modalities, fused), "loss")
                for name, fused in (("", False), (", fused Adam", True))]
    if layer == "fine_tuning":
        return [(name, lambda fused=fused: FineTuningStep(batch, fused), "loss")
                for name, fused in (("", False), (", fused Adam", True))]
    result = []
    for name, draw in DRAWS.items():
        if layer == "regeneration":  # a loop over frames: nothing to compile as a whole
            result.append((", " + name, lambda draw=draw: Regeneration(batch, draw), None))
        elif layer.startswith("generation"):
            steps = int(layer.rsplit("_", 1)[1])
            result.append((", " + name, lambda draw=draw: Generation(batch, steps, draw),
                           "next_frame"))
        elif layer == "joint_likelihood":
            for adam, fused in (("", False), (", fused Adam", True)):
                result.append((", " + name + adam, lambda draw=draw, fused=fused:
                               JointLikelihoodStep(batch, draw, fused), "gradients"))
        else:
            binary, persistent = layer == "binary_crbm", layer.startswith("persistent")
            visible, steps = (300, 1) if binary else (96, 5)
            result.append((", " + name, lambda draw=draw: CrbmStep(
                visible, batch, steps, binary, draw, persistent), "__call__"))
    return result


def compiled(step, method):
    """The step with that method compiled, or None where torch.compile does not work here."""
    if method == "__call__":
        step = torch.compile(step.__call__)
    else:
        setattr(step, method, torch.compile(getattr(step, method)))
    try:
        step()
    except Exception as error:  # no compiler, or a version without it
        print(f"torch.compile: {error}"[:200], file=sys.stderr)
        return None
    return step


def variants(layer, batch):
    """Name to step. What draws is compiled with rand < p, whatever has two Adams with the fused one:
    the faster of each, and compiling takes long."""
    result, all_makers = {}, makers(layer, batch)
    has_two_adams = any("fused Adam" in name for name, _, _ in all_makers)
    for name, make, method in all_makers:
        result["eager" + name] = make()
        slower = "bernoulli" in name or (has_two_adams and "fused Adam" not in name)
        if method and not slower and (step := compiled(make(), method)):
            result["compiled" + name] = step
    return result


def once(step):
    start = time.perf_counter()
    step()
    return time.perf_counter() - start


def measure(steps, seconds):
    """Median microseconds of each step."""
    runs = {name: max(1, min(1000, int(0.01 / once(step)))) for name, step in steps.items()}
    times, end = {name: [] for name in steps}, time.perf_counter() + seconds * len(steps)
    while True:
        for name, step in steps.items():
            start = time.perf_counter()
            for _ in range(runs[name]):
                step()
            times[name].append((time.perf_counter() - start) / runs[name] * 1e6)
        if time.perf_counter() > end:
            break
    return {"pytorch " + name: statistics.median(t) * getattr(steps[name], "TIMES", 1)
            for name, t in times.items()}


def main():
    layer, batch, seconds = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
    torch.set_num_threads(2)
    torch.manual_seed(1)
    if not layer.startswith(("mrbm", "fine_tuning")):
        torch.set_grad_enabled(False)
    steps = variants(layer, batch)
    for step in steps.values():
        step()
    print("{}", flush=True)
    for _ in sys.stdin:
        print(json.dumps(measure(steps, seconds)), flush=True)


main()
