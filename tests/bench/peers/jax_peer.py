"""The mini-batch steps of `mcdbn-cl bench` in JAX, on the CPU: one jitted step, draws by uniform < p.

    python jax_peer.py LAYER BATCH SECONDS

prints {} when it is ready, then {"jax": median_us} for each line of its input. Layers are those of pytorch_peer.py; BATCH is the number of samples of a
generation or regeneration, of windows of fine_tuning.
"""

import functools
import json
import statistics
import sys
import time

import jax
import jax.numpy as jnp
from jax.nn import sigmoid

ORDER, HIDDEN = 5, 300
RATE, RATE_A, MOMENTUM, DECAY = 1e-3, 1e-5, 0.9, 2e-4
FRAMES = 4096


def draw(key, p):
    return (jax.random.uniform(key, p.shape) < p).astype(p.dtype)


def normals(seed, shapes, scale=0.01):
    keys = jax.random.split(jax.random.PRNGKey(seed), len(shapes))
    return {name: scale * jax.random.normal(key, shape)
            for key, (name, shape) in zip(keys, shapes.items())}


def frames_of(seed, visible, binary):
    frames = jax.random.normal(jax.random.PRNGKey(seed), (FRAMES, visible))
    return jnp.clip(0.5 + 0.2 * frames, 0, 1) if binary else frames


def rows_of(batch):
    return jax.random.randint(jax.random.PRNGKey(7), (batch,), ORDER, FRAMES)


def crbm_shapes(visible, hidden=HIDDEN):
    return {"W": (visible, hidden), "A": (ORDER * visible, visible), "B": (ORDER * visible, hidden),
            "a": (visible,), "b": (hidden,)}


def crbm(visible, batch, gibbs_steps, binary, persistent):
    """CD-k as kernels/contrastive_divergence.cl and contrastive_divergence_update.cl do it."""
    frames, rows = frames_of(1, visible, binary), rows_of(batch)
    shapes = crbm_shapes(visible)
    state = (normals(2, shapes), normals(3, shapes, 0.0), jnp.full((batch, HIDDEN), 0.5),
             jax.random.PRNGKey(4), jnp.zeros(()))

    @functools.partial(jax.jit, donate_argnums=0)
    def step(state, frames, rows):
        p, velocity, particles, key, loss = state
        key, *keys = jax.random.split(key, gibbs_steps + 2)
        n = len(rows)
        data = frames[rows]
        history = frames[rows[:, None] + jnp.arange(-ORDER, 0)].reshape(n, -1)
        bias_v = p["a"] + history @ p["A"]
        bias_h = p["b"] + history @ p["B"]
        hidden_data = sigmoid(bias_h + data @ p["W"])
        sample = particles if persistent else draw(keys[0], hidden_data)
        for k in range(gibbs_steps):
            if k > 0:
                sample = draw(keys[k], hidden)
            visible = bias_v + sample @ p["W"].T
            if binary:
                visible = sigmoid(visible)
            hidden = sigmoid(bias_h + visible @ p["W"])
        if persistent:
            particles = draw(keys[gibbs_steps], hidden)
        change_v, change_h = (data - visible) / n, (hidden_data - hidden) / n
        gradients = {"W": (data.T @ hidden_data - visible.T @ hidden) / n, "A": history.T @ change_v,
                     "B": history.T @ change_h, "a": change_v.sum(0), "b": change_h.sum(0)}
        loss += jnp.square(data - visible).mean()
        for name, gradient in gradients.items():
            rate = RATE_A if name == "A" else RATE
            decay = DECAY if name in "WAB" else 0.0
            velocity[name] = MOMENTUM * velocity[name] + rate * (gradient - decay * p[name])
            p[name] = p[name] + velocity[name]
        return p, velocity, particles, key, loss

    return lambda state: step(state, frames, rows), state


def adam(p, mean, square, count, gradients):
    count += 1
    for name, gradient in gradients.items():
        mean[name] = 0.9 * mean[name] + 0.1 * gradient
        square[name] = 0.999 * square[name] + 0.001 * jnp.square(gradient)
        step = mean[name] / (1 - 0.9**count) / (
            jnp.sqrt(square[name] / (1 - 0.999**count)) + 1e-8)
        p[name] = p[name] - 1e-3 * step
    return p, mean, square, count


def adam_state(shapes):
    return (normals(2, shapes), normals(3, shapes, 0.0), normals(3, shapes, 0.0), jnp.zeros(()))


def mrbm(batch, modalities, visible=300, hidden=150, steps=10):
    """Multi-prediction through ten mean-field steps, by autodiff, with Adam."""
    names = range(modalities)
    frames = [frames_of(1 + m, visible, True) for m in names]
    rows = rows_of(batch)
    shapes = {f"W{m}": (visible, hidden) for m in names} | {f"a{m}": (visible,) for m in names} | {
        "b": (hidden,)}

    def loss_of(p, codes):
        total = 0.0
        for absent in names:
            drive = p["b"] + sum(codes[m] @ p[f"W{m}"] for m in names if m != absent)
            W, a = p[f"W{absent}"], p[f"a{absent}"]
            h = sigmoid(drive)
            for t in range(steps):
                logits = a + h @ W.T
                if t + 1 < steps:
                    h = sigmoid(drive + sigmoid(logits) @ W)
            target = codes[absent]
            total += (jax.nn.softplus(logits) - target * logits).sum() / batch
        return total

    @functools.partial(jax.jit, donate_argnums=0)
    def step(state, frames, rows):
        optimizer, total = state
        loss, gradients = jax.value_and_grad(loss_of)(optimizer[0], [f[rows] for f in frames])
        return adam(*optimizer, gradients), total + loss

    return lambda state: step(state, frames, rows), (adam_state(shapes), jnp.zeros(()))


def joint_likelihood(batch, visible=600, hidden=150):
    """CD-1 over both binary modalities at once, with Adam; one matrix, which suits JAX best."""
    frames, rows = frames_of(1, visible, True), rows_of(batch)

    @functools.partial(jax.jit, donate_argnums=0)
    def step(state, frames, rows):
        optimizer, key, losses = state
        p = optimizer[0]
        key, use = jax.random.split(key)
        data = frames[rows]
        hidden_data = sigmoid(p["b"] + data @ p["W"])
        end = sigmoid(p["a"] + draw(use, hidden_data) @ p["W"].T)
        hidden_end = sigmoid(p["b"] + end @ p["W"])
        change = end - data
        losses += jnp.square(change).reshape(batch, 2, -1).mean((0, 2))
        gradients = {"W": (end.T @ hidden_end - data.T @ hidden_data) / batch,
                     "a": change.mean(0), "b": (hidden_end - hidden_data).mean(0)}
        return adam(*optimizer, gradients), key, losses

    state = adam_state({"W": (visible, hidden), "a": (visible,), "b": (hidden,)})
    return lambda state: step(state, frames, rows), (state, jax.random.PRNGKey(4), jnp.zeros(2))


def generation(samples, gibbs_steps, visible=96, frames=1000):
    """1,000 frames of a Gaussian CRBM on its own output, `samples` of them (Algorithm 4)."""
    p = normals(2, crbm_shapes(visible))
    seed = jnp.tile(jax.random.normal(jax.random.PRNGKey(5), (1, ORDER * visible)), (samples, 1))

    @jax.jit
    def run(p, seed, key):
        def next_frame(history, key):
            keys = jax.random.split(key, gibbs_steps)
            bias_v = p["a"] + history @ p["A"]
            bias_h = p["b"] + history @ p["B"]

            def drawn_step(k, v):
                return bias_v + draw(keys[k], sigmoid(bias_h + v @ p["W"])) @ p["W"].T

            v = jax.lax.fori_loop(0, gibbs_steps, drawn_step, history[:, -visible:])
            v = bias_v + sigmoid(bias_h + v @ p["W"]) @ p["W"].T
            return jnp.concatenate([history[:, visible:], v], 1), v

        key, use = jax.random.split(key)
        return key, jax.lax.scan(next_frame, seed, jax.random.split(use, frames))[1]

    return lambda state: run(p, seed, state[0]), (jax.random.PRNGKey(4), None)


def regeneration(samples, frames=1000, track=43, pose=96, gibbs_steps=3, ahead=5, run_in=30):
    """A 1,000-frame clip, `samples` times: up-pass, mean field, sampled down-pass (Algorithm 5)."""
    def layers(seed, visible):
        return [normals(seed, crbm_shapes(visible)), normals(seed + 1, crbm_shapes(HIDDEN))]

    p = {"track": layers(2, track), "pose": layers(4, pose), "mrbm": normals(
        6, {"W0": (HIDDEN, HIDDEN), "W1": (HIDDEN, HIDDEN), "a": (HIDDEN,), "b": (HIDDEN,)})}
    lead = 2 * ORDER + run_in
    clip = jax.random.normal(jax.random.PRNGKey(8), (frames, track))
    clip = jnp.concatenate([jnp.tile(clip[:1], (lead, 1)), clip, jnp.tile(clip[-1:], (ahead, 1))])

    @jax.jit
    def run(p, clip, key):
        code = clip
        for layer in p["track"]:
            count = len(code) - ORDER
            history = code[jnp.arange(count)[:, None] + jnp.arange(ORDER)].reshape(count, -1)
            code = sigmoid(history @ layer["B"] + code[ORDER:] @ layer["W"] + layer["b"])
        top_machine = p["mrbm"]
        drive = code[ahead:] @ top_machine["W0"] + top_machine["b"]
        h = sigmoid(drive)
        for _ in range(5):
            pose_code = sigmoid(h @ top_machine["W1"].T + top_machine["a"])
            h = sigmoid(drive + pose_code @ top_machine["W1"])
        low, top = p["pose"]

        def next_frame(histories, given):
            history_top, history_low = histories
            above, key = given
            keys = jax.random.split(key, 2 * gibbs_steps)
            above = jnp.tile(above[None], (samples, 1))
            bias_v = top["a"] + history_top @ top["A"]
            bias_h = top["b"] + history_top @ top["B"]
            for k in range(gibbs_steps):
                below = draw(keys[2 * k], sigmoid(bias_v + above @ top["W"].T))
                above = draw(keys[2 * k + 1], sigmoid(bias_h + below @ top["W"]))
            below = sigmoid(bias_v + above @ top["W"].T)
            frame = low["a"] + history_low @ low["A"] + below @ low["W"].T
            return (jnp.concatenate([history_top[:, HIDDEN:], below], 1),
                    jnp.concatenate([history_low[:, pose:], frame], 1)), frame

        key, use = jax.random.split(key)
        start = (jnp.zeros((samples, ORDER * HIDDEN)), jnp.zeros((samples, ORDER * pose)))
        given = (pose_code, jax.random.split(use, len(pose_code)))
        return key, jax.lax.scan(next_frame, start, given)[1]

    return lambda state: run(p, clip, state[0]), (jax.random.PRNGKey(4), None)


def fine_tuning(windows, track=43, pose=154, order=10, hidden=768, shared=512, settle=4, judged=20):
    """A mini-batch of fine-tuning in both directions: up-pass, two mean-field steps from zeros, down-pass
    on its own output, squared errors, autodiff; Adam with weight decay, a limit of the gradient's
    length, a moving average of the parameters. Frames without a history have no code to compute."""
    first, steps = order, settle + judged
    frames = first + steps
    sizes = (track, pose)
    data = [jax.random.normal(jax.random.PRNGKey(8 + m), (windows, frames, size))
            for m, size in enumerate(sizes)]
    shapes = {"b": (shared,)}
    for m, size in enumerate(sizes):
        shapes |= {f"W{m}": (size, hidden), f"A{m}": (order * size, size),
                   f"B{m}": (order * size, hidden), f"a{m}": (size,), f"b{m}": (hidden,),
                   f"M{m}": (hidden, shared), f"c{m}": (hidden,)}
    window = first + jnp.arange(steps)[:, None] + jnp.arange(-order, 0)

    def predicted(p, x, present, absent):
        history = x[:, window].reshape(windows, steps, -1)
        code = sigmoid(p[f"b{present}"] + x[:, first:] @ p[f"W{present}"]
                       + history @ p[f"B{present}"])
        drive = p["b"] + code @ p[f"M{present}"]
        v = sigmoid(sigmoid(drive) @ p[f"M{absent}"].T + p[f"c{absent}"])
        h = sigmoid(drive + v @ p[f"M{absent}"])
        v = sigmoid(h @ p[f"M{absent}"].T + p[f"c{absent}"])
        above = v @ p[f"W{absent}"].T + p[f"a{absent}"]

        def next_frame(past, above):
            frame = above + past @ p[f"A{absent}"]
            return jnp.concatenate([past[:, sizes[absent]:], frame], 1), frame

        past = jnp.zeros((windows, order * sizes[absent]))
        return jax.lax.scan(next_frame, past, jnp.swapaxes(above, 0, 1), unroll=4)[1][settle:]

    def loss_of(p, data):
        total = 0.0
        for present, absent, weight in ((0, 1, 1.0), (1, 0, 0.4)):
            target = jnp.swapaxes(data[absent][:, first + settle:], 0, 1)
            total += weight * jnp.square(predicted(p, data[present], present, absent) - target).mean()
        return total

    @functools.partial(jax.jit, donate_argnums=0)
    def step(state, data):
        p, mean, square, average, count, total = state
        loss, gradients = jax.value_and_grad(loss_of)(p, data)
        length = jnp.sqrt(sum(jnp.square(g).sum() for g in gradients.values()))
        count += 1
        for name, gradient in gradients.items():
            gradient = gradient * jnp.minimum(1.0, 1.0 / length)
            mean[name] = 0.9 * mean[name] + 0.1 * gradient
            square[name] = 0.99 * square[name] + 0.01 * jnp.square(gradient)
            change = mean[name] / (1 - 0.9**count) / (
                jnp.sqrt(square[name] / (1 - 0.99**count)) + 1e-8)
            decay = 1.0 if name[0] in "WABM" else 0.0
            p[name] = p[name] - 1e-3 * (change + decay * p[name])
            average[name] = 0.995 * average[name] + 0.005 * p[name]
        return p, mean, square, average, count, total + loss

    zeros = functools.partial(normals, 3, shapes, 0.0)
    return (lambda state: step(state, data)), (normals(2, shapes), zeros(), zeros(), zeros(),
                                               jnp.zeros(()), jnp.zeros(()))


def step_of(layer, batch):
    """(state -> state, the first state)"""
    if layer.startswith("mrbm"):
        return mrbm(batch, 3 if layer == "mrbm_3" else 2)
    if layer == "joint_likelihood":
        return joint_likelihood(batch)
    if layer == "regeneration":
        return regeneration(batch)
    if layer == "fine_tuning":
        return fine_tuning(batch)
    if layer.startswith("generation"):
        return generation(batch, int(layer.rsplit("_", 1)[1]))
    binary = layer == "binary_crbm"
    return crbm(300 if binary else 96, batch, 1 if binary else 5, binary,
                layer.startswith("persistent"))


def measure(step, state, seconds):
    """Median microseconds of a step, and the state after the last."""
    start = time.perf_counter()
    state = jax.block_until_ready(step(state))
    runs = max(1, min(1000, int(0.01 / (time.perf_counter() - start))))
    times, end = [], time.perf_counter() + seconds
    while not times or time.perf_counter() < end:
        start = time.perf_counter()
        for _ in range(runs):
            state = step(state)
        jax.block_until_ready(state)
        times.append((time.perf_counter() - start) / runs * 1e6)
    return statistics.median(times), state


def main():
    layer, batch, seconds = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
    step, state = step_of(layer, batch)
    for _ in range(2):
        state = jax.block_until_ready(step(state))
    print("{}", flush=True)
    for _ in sys.stdin:
        median, state = measure(step, state, seconds)
        print(json.dumps({"jax": median}), flush=True)


main()
