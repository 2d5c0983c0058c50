"""Ctrl-C, callbacks and threads."""

import os
import signal
import threading
import time

import emax
import numpy as np
import pytest
from conftest import wave


def interrupt_after(seconds):
    threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT)).start()


def test_ctrl_c_in_a_long_decimate_gives_the_best_so_far():
    large = wave(150)
    interrupt_after(1.5)
    begun = time.monotonic()
    with pytest.raises(emax.Interrupted) as caught:
        emax.decimate(large, 0.0001, effort="deep")
    assert time.monotonic() - begun < 45
    best = caught.value.result
    assert isinstance(caught.value, KeyboardInterrupt)
    if best is not None:
        assert best.interrupted and best.e_max <= 0.0001
        assert emax.verify(best, cloud=large)


def test_ctrl_c_in_optimize_gives_the_best_so_far():
    turns = np.arange(3000) * 2.399963
    z = 1 - (2 * np.arange(3000) + 1) / 3000
    ball = np.column_stack([np.cos(turns) * np.sqrt(1 - z * z), np.sin(turns) * np.sqrt(1 - z * z), z])
    began = []

    def progress(news):
        if news.evaluations and not began:
            began.append(news)
            interrupt_after(0.1)

    with pytest.raises(emax.Interrupted) as caught:
        emax.optimize(ball, "1%", budget=5000, progress=progress)
    assert began and caught.value.result.e_max <= 0.02


def test_a_callback_may_end_the_work():
    large = wave(90)

    def enough(news):
        raise StopIteration

    assert emax.decimate(large, 0.0001, effort="deep", progress=enough).interrupted

    class OwnError(Exception):
        pass

    def fails(news):
        raise OwnError

    with pytest.raises(OwnError):
        emax.decimate(large, 0.0001, effort="deep", progress=fails)


def test_the_gil_is_released(mesh):
    counted, ended = [0], threading.Event()

    def count():
        while not ended.is_set():
            counted[0] += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    made = [None, None]

    def work(i):
        made[i] = emax.decimate(wave(50), 0.001, threads=1)

    workers = [threading.Thread(target=work, args=(i,)) for i in range(2)]
    begun = time.monotonic()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    took = time.monotonic() - begun
    ended.set()
    counter.join()
    assert made[0].vertices.tobytes() == made[1].vertices.tobytes()
    assert counted[0] > 20 * took, f"{counted[0]} in {took} s"


def test_minimize_ends_early():
    def interrupted(x):
        if (seen := seen_by.append(x) or len(seen_by)) == 30:
            os.kill(os.getpid(), signal.SIGINT)
        return float(x @ x)

    seen_by = []
    with pytest.raises(emax.Interrupted) as caught:
        emax.minimize(interrupted, [(-5, 5)] * 2, budget=1000)
    assert caught.value.result.fun < 25
    bests = []

    def told(best):
        bests.append(best.fun)
        return len(bests) == 3

    found = emax.minimize(lambda x: float(x @ x), [(-5, 5)] * 2, budget=1000, callback=told)
    assert found.nfev < 1000 and not found.success and bests == sorted(bests, reverse=True)
    with pytest.raises(ZeroDivisionError):
        emax.minimize(lambda x: 1 / 0, [(-5, 5)])
    with pytest.raises(ValueError, match="bounds"):
        emax.minimize(lambda x: 0, [(0, np.inf)])
