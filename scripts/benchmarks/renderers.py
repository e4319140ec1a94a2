"""Renderers as the error benchmark sees them: each renders one scene at a number of samples with a seed.

A renderer has a name, `setup_seconds`, and `render(spp, seed) -> (seconds, picture)`; the picture is an array of
height x width x 3, linear RGB. A peer runs in a process of its own, pinned to the cores it may use, and answers one line
of JSON a line (`worker` below).
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from common import comparable_scene, pin, run_wavelobe
import luxcore_peer
from scene_facts import Missing


def load_picture(path):
    import flip_evaluator

    return np.asarray(flip_evaluator.load(str(path)), dtype=np.float64)[..., :3]


class Wavelobe:
    name = "wavelobe"

    def __init__(self, source, size, threads):
        self.scene = comparable_scene(source, size, 1)
        self.threads = threads
        self.picture = self.scene.with_suffix(f".{threads}.exr")
        self.render(1, 0)  # fills the kernel cache

    def render(self, spp, seed):
        stats = run_wavelobe(self.scene, self.picture, self.threads, "--seed", seed, "--spp", spp)
        self.setup_seconds = stats["setup_seconds"]
        return stats["render_seconds"], load_picture(self.picture)

    def close(self):
        pass


class Worker:
    """A peer behind a pipe. `kind` and `setting` name a class of `PEERS` and what it is told."""

    def __init__(self, kind, setting, source, size, threads):
        self.name = f"{kind}-{setting}" if setting else kind
        self.picture = comparable_scene(source, size, 1).with_suffix(f".{self.name}.npy")
        command = [sys.executable, __file__, kind, setting, source, str(size), str(threads), self.picture]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                        preexec_fn=lambda: pin(threads),
                                        env={**os.environ, **(luxcore_peer.environment() if kind == "luxcore" else {})})
        hello = self.answer()
        if "missing" in hello:
            self.close()
            raise Missing(hello["missing"])
        self.version, self.setup_seconds = hello["version"], hello["setup_seconds"]

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            self.close()
            raise Missing(f"its process ended with code {self.process.returncode}")
        return json.loads(line)

    def render(self, spp, seed):
        self.process.stdin.write(json.dumps({"spp": spp, "seed": seed}) + "\n")
        self.process.stdin.flush()
        return self.answer()["seconds"], np.load(self.picture).astype(np.float64)

    def close(self):
        self.process.stdin.close()
        self.process.wait()


class MitsubaPeer:
    """Mitsuba 3: `setting` is variant:sampler, such as llvm_ad_rgb:multijitter."""

    samples_a_pass = 1 << 24  # one wavefront holds all samples of a pass

    def __init__(self, setting, source, size, threads):
        import drjit
        import mitsuba

        variant, sampler = setting.split(":")
        # The pool hangs with a single thread; the process is pinned all the same.
        drjit.set_thread_count(max(threads, 2))
        mitsuba.set_variant(variant)
        self.mitsuba, self.drjit, self.version = mitsuba, drjit, mitsuba.__version__
        self.scene = mitsuba.load_file(str(comparable_scene(source, size, 1, sampler)))
        self.pass_spp = self.samples_a_pass // (size * size)
        self.render(1, 0)  # compiles

    def render_pass(self, spp, seed):
        image = self.mitsuba.render(self.scene, spp=spp, seed=seed)
        self.drjit.eval(image)
        self.drjit.sync_thread()
        return np.array(image)[..., :3]

    def render(self, spp, seed):
        start = time.perf_counter()
        total = 0.0
        for first in range(0, spp, self.pass_spp):
            share = min(self.pass_spp, spp - first)
            total = total + self.render_pass(share, seed * 64 + first // self.pass_spp) * (share / spp)
        return time.perf_counter() - start, total


def cycles_peer(setting, source, size, threads):
    from cycles_peer import CyclesPeer

    return CyclesPeer(comparable_scene(source, size, 1), threads)


def luxcore(setting, source, size, threads):
    return luxcore_peer.LuxCorePeer(comparable_scene(source, size, 1), threads)


PEERS = {"mitsuba": MitsubaPeer, "cycles": cycles_peer, "luxcore": luxcore}


def peer_settings(names):
    """The (kind, setting) pairs that peers named on the command line stand for."""
    pairs = []
    for name in names:
        kind, _, setting = name.partition("-")
        if name == "mitsuba":
            pairs += [("mitsuba", "llvm_ad_rgb:independent"), ("mitsuba", "llvm_ad_rgb:multijitter")]
        elif kind in PEERS:
            pairs.append((kind, setting))
        else:
            raise Missing(f"no such peer: {name}; there are {', '.join(sorted(PEERS))}, and mitsuba-VARIANT:SAMPLER")
    return pairs


def worker(kind, setting, source, size, threads, picture):
    # What a renderer prints must not get between the answers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)

    def say(**answer):
        answers.write(json.dumps(answer) + "\n")
        answers.flush()

    start = time.perf_counter()
    try:
        peer = PEERS[kind](setting, Path(source), int(size), int(threads))
    except ImportError as error:
        say(missing=f"{error}; build/venv/bin/pip install brings mitsuba, bpy for Cycles and pyluxcore for LuxCore")
        return
    except Missing as error:
        say(missing=str(error))
        return
    say(version=peer.version, setup_seconds=time.perf_counter() - start)
    for line in sys.stdin:
        question = json.loads(line)
        seconds, image = peer.render(question["spp"], question["seed"])
        np.save(picture, np.asarray(image, dtype=np.float32))
        say(seconds=seconds)


if __name__ == "__main__":
    worker(*sys.argv[1:])
