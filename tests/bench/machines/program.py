"""mcdbn-cl as a peer sees it: fit a machine to arrays, read its parameters and its time back."""

import json
import subprocess
import tempfile
import time
from pathlib import Path

import numpy

CLI = Path("build/cli/mcdbn-cl")


def read_tensors(path):
    """The tensors of a .safetensors file, by name."""
    content = Path(path).read_bytes()
    length = int.from_bytes(content[:8], "little")
    header, data = json.loads(content[8:8 + length]), content[8 + length:]
    return {name: numpy.frombuffer(data[slice(*about["data_offsets"])], "<f4").reshape(about["shape"])
            for name, about in header.items() if name != "__metadata__"}


class Fitted:
    """A machine that mcdbn-cl fitted to arrays, each a sequence."""

    def __init__(self, arrays, machine, options, cli=CLI):
        self.cli = cli
        self.folder = tempfile.TemporaryDirectory()
        files = [self.put(f"data_{i:03}.npy", array) for i, array in enumerate(arrays)]
        start = time.perf_counter()
        self.run("fit", *files, "--machine", machine, "-o", self.path("machine.safetensors"), "--quiet",
                 *options.split())
        self.wall_s = time.perf_counter() - start
        tensors = read_tensors(self.path("machine.safetensors"))
        self.parameters = {name.split(".")[-1]: tensor for name, tensor in tensors.items()}
        lines = self.path("machine.metrics.jsonl").read_text().splitlines()
        self.windows_per_s = [json.loads(line)["windows_per_s"] for line in lines]

    def path(self, name):
        return Path(self.folder.name) / name

    def put(self, name, array):
        numpy.save(self.path(name), array.astype(numpy.float32))
        return self.path(name)

    def run(self, *arguments):
        return subprocess.run([str(a) for a in (self.cli, *arguments)], check=True, capture_output=True,
                              text=True).stdout

    def score(self, array):
        return json.loads(self.run("score", "--model", self.path("machine.safetensors"),
                                   self.put("scored.npy", array), "--json"))
