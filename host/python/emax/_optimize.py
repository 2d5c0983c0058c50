from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
from pathlib import Path as FilePath
from typing import Any, Callable

from . import _core
from ._inputs import CloudLike, Length, Path, given_cloud, length_text, one_of, share_text
from ._program import program
from ._results import CertifiedMesh, Progress, Reconstruction, outcome

_KEPT = 0  # exit codes of the command
_NO = 2
_INTERRUPTED = 130


def _progress_of(line: dict[str, Any]) -> Progress:
    known = {key: line[key] for key in Progress.__dataclass_fields__ if line.get(key) is not None}
    return Progress(**known)


class _Run:
    """`emax optimize` in a process of its own, whose messages and progress are read."""

    def __init__(self, words: list[str], progress: Callable[[Progress], object] | None) -> None:
        self.progress = progress
        self.stopped_by: BaseException | None = None
        self.said: list[str] = []
        # A process group of its own: Ctrl-C comes here, and is passed on once.
        self.process = subprocess.Popen([program(), *words], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                        text=True, errors="replace", process_group=0)

    def stop(self, because: BaseException) -> None:
        if self.stopped_by is None:
            self.stopped_by = because
            self.process.send_signal(signal.SIGINT)

    def _take(self, line: str) -> None:
        if not line.startswith("{"):
            self.said.append(line.strip())
        elif self.progress is not None and self.stopped_by is None:
            self.progress(_progress_of(json.loads(line)))

    def wait(self) -> int:
        assert self.process.stderr is not None
        while True:
            try:
                for line in self.process.stderr:
                    self._take(line)
                code = self.process.wait()
                self.process.stderr.close()
                return code
            except BaseException as exception:  # of Ctrl-C or of the callback
                self.stop(exception)


def optimize(
    cloud: CloudLike,
    max_error: Length,
    *,
    output: Path | None = None,
    effort: str = "normal",
    budget: int | None = None,
    seed: int = 1,
    jobs: int | None = None,
    time: float | None = None,
    target_triangles: int | None = None,
    stagnation: int | None = None,
    method: str = "fit",
    decimator: str = "bounded",
    bound: str | None = None,
    features: str = "none",
    closed: bool = False,
    polish: bool | None = None,
    exclude_outliers: float | str = 0,
    skip_invalid: bool = False,
    unit: str | None = None,
    config: Path | None = None,
    progress: Callable[[Progress], object] | None = None,
) -> CertifiedMesh:
    """Searches the mesh of a scan with the fewest triangles within ``max_error``.

    This is ``emax optimize``, in a process of its own with the workers of the package; the options
    have the meanings of the command's, and the bytes are the same. With ``output`` the files are
    written there, and a run that was stopped goes on with the same call. Without it nothing is
    left on the disk; the result's ``save`` writes the files. Ctrl-C raises
    :class:`Interrupted`, whose ``result`` is the best mesh so far.

    >>> import numpy as np, emax
    >>> turns = np.arange(900) * 2.399963
    >>> z = 1 - (2 * np.arange(900) + 1) / 900
    >>> ball = np.column_stack([np.cos(turns) * np.sqrt(1 - z * z), np.sin(turns) * np.sqrt(1 - z * z), z])
    >>> made = emax.optimize(ball, "2%", effort="quick", jobs=1)
    >>> made.e_max <= 0.04, made.back <= 0.04, made.certificate["valid"]
    (True, True, True)
    """
    given = given_cloud(cloud, skip_invalid=skip_invalid)
    with tempfile.TemporaryDirectory(prefix="emax-") as folder:
        source = given.file
        if not source:
            source = os.path.join(folder, "mesh.ply.cloud.ply")
            FilePath(source).write_bytes(given.ply_bytes())
        mesh = os.path.join(folder, "mesh.ply") if output is None else os.fspath(output)
        report = os.path.join(folder, "report.json")
        one_of(effort, ("quick", "normal", "deep"), "effort")
        words = ["optimize", source, "--max-error", length_text(max_error, "max_error"), "-o", mesh,
                 "--json", report, "--progress", "json", "--effort", effort, "--seed", str(seed),
                 "--method", method, "--decimator", decimator, "--features", features,
                 "--exclude-outliers", share_text(exclude_outliers)]
        options = {"--budget": budget, "--jobs": jobs, "--time": time, "--unit": unit, "--bound": bound,
                   "--target-triangles": target_triangles, "--stagnation": stagnation}
        words += [word for option, value in options.items() if value is not None
                  for word in (option, str(value))]
        words += [] if config is None else ["--config", os.fspath(config)]
        words += ["--closed"] * closed + ["--skip-invalid"] * skip_invalid
        if polish is not None:
            words.append("--polish" if polish else "--no-polish")
        run = _Run(words, progress)
        code = run.wait()
        result = None
        told = json.loads(FilePath(report).read_text()) if os.path.exists(report) else None
        if os.path.exists(mesh + ".certificate.json") and os.path.exists(mesh):
            made = _core.certified_of_files(mesh, None if given.file else given)
            result = CertifiedMesh(made, given.points, run.stopped_by is not None or code == _INTERRUPTED, told)
        if run.stopped_by is None and (result is None or code not in (_KEPT, _NO, _INTERRUPTED)):
            raise _core.Error(_failure(run.said, code, told))
        return outcome(result, run.stopped_by)


def _failure(said: list[str], code: int, report: dict[str, Any] | None) -> str:
    for line in reversed(said):
        if line.startswith("emax: "):
            return line.removeprefix("emax: ")
    if code == _NO and report is not None:
        return (f"max_error: no mesh was found within the tolerance; the least error of one is "
                f"{report['e_max']}: raise max_error or budget, or exclude points with exclude_outliers")
    return f"emax optimize ended with {code}: {' '.join(said) or 'no message'}"


def reconstruct(
    cloud: CloudLike,
    max_error: Length,
    *,
    method: str = "fit",
    closed: bool = False,
    exclude_outliers: float | str = 0,
    skip_invalid: bool = False,
    jobs: int = 0,
) -> Reconstruction:
    """Makes the surface that fits a scan: the reference that ``optimize`` starts from.

    Points farther than half of ``max_error`` from the surface of the ``method`` become its vertices.
    ``fit`` takes the method that fits best. The workers of the package do the reconstruction. Ctrl-C
    raises :class:`Interrupted`.

    >>> import numpy as np, emax
    >>> x, y = np.meshgrid(np.linspace(0, 1, 15), np.linspace(0, 1, 15))
    >>> dome = np.column_stack([x.ravel(), y.ravel(), (x * (1 - x) * y * (1 - y)).ravel()])
    >>> surface = emax.reconstruct(dome, max_error=0.01, jobs=1)
    >>> surface.e_max <= 0.01, len(surface.outliers)
    (True, 0)
    """
    question = _core.ReconstructQuestion()
    question.max_error = length_text(max_error, "max_error")
    question.method, question.closed = method, closed
    question.exclude_outliers = share_text(exclude_outliers)
    question.worker = program("emax_worker")
    question.jobs = jobs
    given = given_cloud(cloud, skip_invalid=skip_invalid)
    made, stopped_by = _core.reconstruct(given, question)
    return outcome(None if made is None else Reconstruction(made, given.points), stopped_by)
