#!/usr/bin/env python3
"""Makes the run that other tests read. usage: shared_run.py PROGRAM FOLDER"""
import pathlib
import pickle
import shutil
import sys

from program import SHARED_CASE, SHARED_RANKS, Run


def main():
    folder = pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run = Run(sys.argv[1], SHARED_CASE, SHARED_RANKS, folder=folder)
    assert run.code == 0, run.text
    (folder / "run.pickle").write_bytes(pickle.dumps(run))


if __name__ == "__main__":
    main()
