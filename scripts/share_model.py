#!/usr/bin/env python3
"""Makes a model ready to be passed on: share_model.py MODEL OUT ACKNOWLEDGEMENT [START]

Training clips, and the model that the training began with, keep their names and fingerprints and
lose the folders that they lay in, and clips the people and actions in them; the acknowledgement
goes into the metadata. Numbers stay as they are. START is that model's file: which models it is a
mean of (`mean_of`), if any, is put down, too.
"""

import json
import pathlib
import sys

from model_file import read_model, write_model


def shared(header: dict, acknowledgement: str) -> dict:
    about = json.loads(header["__metadata__"]["mcdbn"])
    for clip in about["training_clips"]:
        clip["path"] = pathlib.Path(clip["path"]).name
        clip.pop("person", None)
        clip.pop("action", None)
    if "started_from" in about:
        start = about["started_from"]
        start["model"] = pathlib.Path(start["model"]).name
    metadata = {"acknowledgement": acknowledgement, "mcdbn": json.dumps(about)}
    return {**header, "__metadata__": {**header["__metadata__"], **metadata}}


def main() -> None:
    if len(sys.argv) < 4:
        sys.exit("share_model.py MODEL OUT ACKNOWLEDGEMENT [START]")
    source, target, acknowledgement, *start = sys.argv[1:]
    header, numbers = read_model(source)
    for path in start:
        begun = read_model(path)[0]["__metadata__"]
        header["__metadata__"].update({"mean_of": begun["mean_of"]} if "mean_of" in begun else {})
    write_model(target, shared(header, acknowledgement), numbers)


if __name__ == "__main__":
    main()
