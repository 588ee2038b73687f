"""The package against published numbers, against the command line to the last digit, and its manners."""

import json
import os
import pickle
import signal
import subprocess
import threading
import time
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import numpy as np
import pytest

import stuart_landau
from stuart_landau import ComputationError, InputError, Model, built

ROOT = Path(__file__).resolve().parents[3]
LANDAU = os.environ.get("LANDAU", str(ROOT / "target" / "release" / "landau"))


def command(line):
    """What the command line says."""
    answer = subprocess.run([LANDAU, *line.split(), "--json"], cwd=ROOT, capture_output=True, text=True, check=True)
    return json.loads(answer.stdout)


def test_published_numbers():
    point = Model("swift_hohenberg").point(k=1, r=0.1, b=1, order=5)
    assert point.c2.real == pytest.approx(0.856143856143856144, rel=1e-12)
    assert point.c4.real == pytest.approx(-29.8936180109206892, rel=1e-11)
    convection = Model("rayleigh_benard")
    onset = convection.critical("Ra", (1500, 2000), minimize=(2.5, 4.0), M=32)
    assert onset.value == pytest.approx(1707.761777104718, rel=1e-10)
    assert onset.k == pytest.approx(3.116323554821122, rel=1e-8)
    assert onset.envelope["xi0_squared"] == pytest.approx(0.14803445243, rel=1e-8)
    assert "tau0" in repr(onset)
    rolls = convection.point(k=3.116323554821122, Ra=1707.761777104718, Pr=7, M=32)
    assert rolls.c2.real == pytest.approx(-238.7135246614527, rel=1e-8)
    pair = Model("swift_hohenberg").amplitudes([0.62, 1.24], r=0.3, b=0.5)
    assert pair.coefficient(0, [2, 0], [1, 0]).real == pytest.approx(-1.15523096803, rel=1e-10)
    waves = Model("brusselator").point(k=1, A=2, B=7, D1=1, D2=1).waves
    assert waves["stable"] == "travelling"


def test_the_command_line_to_the_last_digit():
    bed = Model("vibrated_bed")
    assert bed.point(k=0.16, order=5).data == command("point vibrated_bed --k 0.16 --order 5")
    assert bed.spectrum(k=0.1, M=40).data == command("spectrum vibrated_bed --k 0.1 -M 40")
    assert bed.base(S=200, H="auto").tail == command("base vibrated_bed --set S=200 --set H=auto")["tail"]
    assert bed.verify(k=0.16).data == command("verify vibrated_bed --k 0.16")
    strip = Model("swift_hohenberg_strip")
    found = strip.amplitudes([0.63, 1.26], r=1.36, b=0.5, M=30).data
    assert found == command("amplitudes swift_hohenberg_strip --mode k=0.63 --mode k=1.26 --set r=1.36 --set b=0.5 -M 30")


def test_sweeps(tmp_path):
    model = Model("swift_hohenberg")
    sweep = model.sweep(k=np.linspace(0.9, 1.1, 5), r=[0.1, 0.2, 0.3], b=0.5)
    assert sweep.c2.shape == (5, 3)
    assert np.all(sweep.status == "ok")
    exact = model.point(k=0.95, r=0.2, b=0.5)
    assert sweep.c2[1, 1] == pytest.approx(exact.c2, rel=1e-12)
    assert sweep.c0[2, 2].real == pytest.approx(0.3, abs=1e-12)
    dataset = sweep.to_xarray()
    assert dict(dataset.sizes) == {"k": 5, "r": 3}
    assert dataset.attrs["model"] == "swift_hohenberg"
    assert float(dataset.c2_re.sel(r=0.2).isel(k=1)) == sweep.c2[1, 1].real
    assert len(sweep.plot()) == 3
    rolls = Model("rayleigh_benard").sweep(Ra=[1800.0, 2000.0], k=3.117, columns=["nusselt", "integral(theta)"])
    # Clever & Busse (1974) at Pr = 0.71: 1.212; at Pr = 1 alike.
    assert rolls.derived["nusselt"][1] == pytest.approx(1.212, abs=5e-3)
    assert np.all(rolls.derived["integral(theta)"] == 0)
    assert rolls.to_xarray().nusselt.shape == (2,)
    with pytest.raises(InputError, match="nuselt"):
        Model("rayleigh_benard").sweep(Ra=[1800.0], k=3.117, columns=["nuselt"])
    out = tmp_path / "sweep.csv"
    model.sweep(k=[0.9, 1.0], r=0.1, out=out)
    assert out.read_text().startswith("k,c0_re")
    described = json.loads((tmp_path / "sweep.csv-metadata.json").read_text())
    assert described["landau:model"] == "swift_hohenberg"
    assert [c["titles"] for c in described["tableSchema"]["columns"]] == out.read_text().splitlines()[0].split(",")


def test_datasets_are_those_of_the_files(tmp_path):
    """Variables, values and attributes of every dataset, beside what the command line stores."""
    bed = Model("vibrated_bed")
    given = {"S": 200.0, "top": "neumann"}
    options = "--set S=200 --set top=neumann"
    for line, found in (
        (f"base vibrated_bed --points 41 {options}", bed.base(points=41, **given)),
        (f"spectrum vibrated_bed --k 0.1 -M 30 {options}", bed.spectrum(0.1, M=30, **given)),
        (f"point vibrated_bed --k 0.16 {options}", bed.modes(0.16, **given)),
        (f"pattern vibrated_bed --k 0.16 --points 9x17 {options}", bed.pattern(0.16, points=(9, 17), **given)),
    ):
        file = tmp_path / "arrays.npz"
        command(f"{line} --out {file}")
        dataset = found.to_xarray()
        with np.load(file) as stored:
            attributes = json.loads(bytes(stored["attributes"]))
            names = [*dataset.variables]
            assert sorted(names) == sorted(name for name in stored.files if name != "attributes"), line
            for name in names:
                np.testing.assert_array_equal(dataset[name].values, stored[name])
                assert set(dataset[name].attrs) == {"units", "long_name"}
        assert dataset.attrs == attributes, line
    swept = bed.sweep(S=[100.0, 200.0], k=0.16, top="neumann").to_xarray()
    assert swept.attrs["k"] == 0.16
    assert swept.attrs["parameter_top"] == "neumann"
    assert "parameter_S" not in swept.attrs
    assert swept.c0_error.attrs["long_name"] .startswith("absolute error of c0")


def test_errors_travel():
    with pytest.raises(InputError) as raised:
        Model("rayleigh_benard").point(3.1, nonsense=1)
    again = pickle.loads(pickle.dumps(raised.value))
    assert type(again) is InputError
    assert str(again) == str(raised.value)


def test_pictures_and_tables():
    bed = Model("vibrated_bed")
    point = bed.point(k=0.16)
    assert "supercritical" in repr(point) and "<pre>" in point._repr_html_()
    for part in ("distance to resonance", "envelope: dc0/dk", "± "):
        assert part in repr(point), repr(point)
    assert point._repr_latex_().startswith("$$ \\frac{dA}{dt}")
    assert "±" in repr(bed.amplitudes([0.16]))
    assert bed.modes(k=0.16)["X[1;1]"]["n"].shape == (201,)
    bed.modes(k=0.16).plot()
    bed.base().plot()
    bed.spectrum(k=0.16).plot()
    pattern = bed.pattern(k=0.16, points=(33, 17))
    assert pattern.nonlinear["T"].shape == (17, 33)
    assert pattern.to_xarray().n_nonlinear.dims == ("y", "x")
    pattern.plot("T")
    assert any(r"\partial" in row for row in bed.operators.latex("L"))
    assert "boundary conditions" in bed.operators.text("adjoint")


def test_texts_and_pickles():
    text = (ROOT / "spec" / "models" / "swift_hohenberg.model").read_text()
    model = Model.from_text(text)
    assert model.point(k=1, b=0.5).data == pickle.loads(pickle.dumps(model)).point(k=1, b=0.5).data
    restored = pickle.loads(pickle.dumps(Model("vibrated_bed")))
    assert restored.point(k=0.16).c0 == pytest.approx(Model("vibrated_bed").point(k=0.16).c0, rel=1e-9)
    other = Model(ROOT / "spec" / "models" / "brusselator.model")
    assert other.name == "brusselator" and set(other.fields) == {"u", "v"}
    assert "vibrated_bed" in built() and stuart_landau.__version__


def test_errors_are_exceptions():
    model = Model("swift_hohenberg")
    with pytest.raises(InputError, match="no parameter `q`"):
        model.point(k=1, q=2)
    with pytest.raises(InputError, match="did you mean"):
        Model("swift_hohenburg")
    with pytest.raises(ValueError, match="text.model:2"):
        Model.from_text('model m "a model";\nfeilds { u; }')
    with pytest.raises(ComputationError, match="does not change sign"):
        model.critical("r", (0.5, 0.6), k=1.0)
    with pytest.raises(InputError, match="nothing varies"):
        model.sweep(k=1.0)
    with pytest.raises(InputError, match="`r` is set twice, by set and by a keyword"):
        model.point(k=1, set={"r": 0.1}, r=0.2)
    with pytest.raises(InputError, match="`r` is set twice, by set and by a keyword"):
        model.sweep(k=1, set={"r": 0.1}, r=[0.2, 0.3])
    with pytest.raises(InputError, match="odd numbers"):
        model.point(k=1, order=4)


def test_ctrl_c_ends_a_sweep(tmp_path):
    bed = Model("vibrated_bed")
    out = tmp_path / "long.csv"
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    started = time.monotonic()
    threading.Timer(1.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            bed.sweep(k=np.linspace(0.03, 0.18, 4000), S=np.linspace(80, 400, 50), out=out)
    finally:
        signal.signal(signal.SIGINT, handler)
    assert time.monotonic() - started < 4.0
    assert not out.exists()


def test_the_interpreter_is_free_meanwhile():
    bed = Model("vibrated_bed")
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.005)

    thread = threading.Thread(target=count)
    thread.start()
    bed.sweep(k=np.linspace(0.1, 0.17, 200))
    done.set()
    thread.join()
    assert counted > 10


def test_the_notebook_runs(tmp_path, monkeypatch):
    notebook = json.loads((ROOT / "solver" / "python" / "examples" / "figure6.ipynb").read_text())
    monkeypatch.chdir(tmp_path)
    scope = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), "figure6.ipynb", "exec"), scope)
    # The paper prints 0.0366, 0.1748 and 0.0703.
    assert scope["upper"].value == pytest.approx(0.17454, abs=2e-5)
    assert scope["sign"].value == pytest.approx(0.0705, abs=1e-4)
    assert scope["swapped"].c0.real == pytest.approx(0.0045444655, abs=1e-9)
    assert scope["swapped"].c2.real == pytest.approx(-0.0045849456, abs=1e-9)


def test_a_cluster_of_two_workers(tmp_path):
    """Two workers of a local HyperQueue cluster: the file is the plain one, byte for byte."""
    from hyperqueue.cluster import LocalCluster, WorkerConfig

    model = Model("swift_hohenberg")
    places = {"k": np.linspace(0.8, 1.2, 101), "r": [0.1, 0.2, 0.3], "b": 0.5}
    plain = model.sweep(**places, out=tmp_path / "plain.csv")
    with LocalCluster(str(tmp_path / "server"), WorkerConfig(cores=1)) as cluster:
        cluster.start_worker(WorkerConfig(cores=1))
        found = model.sweep(**places, out=tmp_path / "shared.csv", cluster=cluster.client(), tasks=5)
    assert (tmp_path / "shared.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()
    assert np.array_equal(found.c2, plain.c2) and np.array_equal(found.status, plain.status)
    assert not list(tmp_path.glob("*.shard-*"))


def test_a_share_that_was_killed_is_computed_again(tmp_path):
    """A worker's process killed in the middle: its share starts anew, or goes on, and the merged file is the plain one."""
    import pickle as pickles
    import sys

    bed = Model("vibrated_bed")
    axes = [("k", list(np.linspace(0.05, 0.17, 200)))]
    assignment = {
        "set": ["H=40.0"], "resolution": 40, "axes": axes, "k": None, "near": None, "follow": False, "columns": [],
    }
    file = tmp_path / "assignment"
    file.write_bytes(pickles.dumps((bed, assignment)))
    plain = tmp_path / "plain.csv"
    bed.sweep(k=axes[0][1], H=40.0, M=40, out=plain)

    def share(index):
        out = tmp_path / f"part-{index}"
        command = [sys.executable, "-m", "stuart_landau.cluster", str(file), str(index), "2", str(out)]
        return subprocess.Popen(command, cwd=tmp_path), out

    first, one = share(1)
    time.sleep(0.8)
    first.kill()
    first.wait()
    again, one = share(1)
    second, two = share(2)
    assert again.wait() == 0 and second.wait() == 0
    stuart_landau._core.Core.merge([str(one), str(two)], str(tmp_path / "merged.csv"))
    assert (tmp_path / "merged.csv").read_bytes() == plain.read_bytes()


def test_a_cluster_that_dies_is_followed_by_another(tmp_path):
    """All workers of a cluster killed in the middle of a sweep: a new one goes on, and the file is the plain one."""
    import sys

    script = """
import sys
import numpy as np
from hyperqueue.cluster import LocalCluster, WorkerConfig
from stuart_landau import Model

folder = sys.argv[1]
with LocalCluster(folder + "/server" + sys.argv[2], WorkerConfig(cores=1)) as cluster:
    cluster.start_worker(WorkerConfig(cores=1))
    places = np.linspace(0.05, 0.17, 3000)
    Model("vibrated_bed").sweep(k=places, M=40, out=folder + "/shared.csv", cluster=cluster.client(), tasks=6)
"""

    def start(number):
        command = [sys.executable, "-c", script, str(tmp_path), str(number)]
        return subprocess.Popen(command, cwd=tmp_path, start_new_session=True)

    first = start(1)
    end = time.monotonic() + 60
    while not list(tmp_path.glob("shared.csv.shard-*")) and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(0.3)
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    assert not (tmp_path / "shared.csv").exists(), "it was killed too late"
    # What a worker had started may live on for a moment.
    subprocess.run(["pkill", "-KILL", "-f", str(tmp_path)], check=False)
    assert start(2).wait(timeout=120) == 0
    plain = Model("vibrated_bed").sweep(k=np.linspace(0.05, 0.17, 3000), M=40, out=tmp_path / "plain.csv")
    assert (tmp_path / "shared.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()
    assert np.all(plain.c0.real != 0)


def forked(queue):
    sweep = Model("swift_hohenberg_strip").sweep(k=np.linspace(0.9, 1.1, 60), r=1.2, M=20)
    queue.put(sweep.c2)


def test_a_forked_process_computes():
    """A fork copies no thread: the child starts threads of its own, and finds what the parent finds."""
    import multiprocessing

    context = multiprocessing.get_context("fork")
    expected = Model("swift_hohenberg_strip").sweep(k=np.linspace(0.9, 1.1, 60), r=1.2, M=20).c2
    for _ in range(2):
        queue = context.Queue()
        child = context.Process(target=forked, args=(queue,), daemon=True)
        child.start()
        found = queue.get(timeout=60)
        child.join(timeout=60)
        assert child.exitcode == 0
        assert np.array_equal(found, expected, equal_nan=True)
    # The parent's threads are still its own.
    assert np.array_equal(Model("swift_hohenberg_strip").sweep(k=np.linspace(0.9, 1.1, 60), r=1.2, M=20).c2, expected)


def test_ctrl_c_ends_a_single_computation():
    """A computation without steps is left to itself, and the next one does not wait for it."""
    bed = Model("vibrated_bed")
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    started = time.monotonic()
    threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            bed.point(k=0.16, M=900)
    finally:
        signal.signal(signal.SIGINT, handler)
    assert time.monotonic() - started < 3.0
    assert Model("swift_hohenberg").point(k=1, r=0.1).c0.real == pytest.approx(0.1, abs=1e-12)
    assert time.monotonic() - started < 10.0


def test_other_tables_are_kept(tmp_path):
    """A table of another sweep, and a file of somebody else, are replaced with `force` alone."""
    model = Model("swift_hohenberg")
    out = tmp_path / "a.csv"
    model.sweep(k=[0.9, 1.0], r=0.1, out=out)
    model.sweep(k=[0.9, 1.0], r=0.1, out=out)
    with pytest.raises(InputError, match="r is 0.2 here and 0.1 there"):
        model.sweep(k=[0.9, 1.0], r=0.2, out=out)
    model.sweep(k=[0.9, 1.0], r=0.2, out=out, force=True)
    out.write_text("mine\n")
    with pytest.raises(InputError, match="a.csv"):
        model.sweep(k=[0.9, 1.0], r=0.2, out=out)
    assert out.read_text() == "mine\n"
