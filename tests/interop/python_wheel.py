"""The wheel as a stranger gets it: built by maturin, installed by pip and by uv where nothing else is, tried, and removed.
Usage: python_wheel.py FOLDER [WHEEL], by a Python beside which maturin and uv are; a WHEEL that is there is not built."""
import os
import pathlib
import re
import subprocess
import sys
import zipfile

root = pathlib.Path(__file__).parent.parent.parent
package, out = root / "assets" / "python", pathlib.Path(sys.argv[1]).absolute()
tools = pathlib.Path(sys.executable).parent
# No program of another build, and no package from the source tree.
bare = {key: value for key, value in os.environ.items() if key not in ("HANDSCOPE", "PYTHONPATH")} | {"PATH": "/usr/bin:/bin"}


def run(*command, **more):
    print("+", *command, flush=True)
    return subprocess.run([str(word) for word in command], check=True, **more)


def files(folder):
    return {path for path in folder.rglob("*") if path.suffix != ".pyc" and path.name != "__pycache__"}


def newest_glibc(program):
    """The newest version of the C library that a program asks for: no less may stand in the name of its wheel."""
    return max(tuple(map(int, found)) for found in re.findall(rb"GLIBC_(\d+)\.(\d+)", program))


build = [tools / "maturin", "build", "--profile", "dev", "--locked", "--out", out / "wheels"]
if len(sys.argv) == 2:
    run(*build, cwd=package, env=os.environ | {"PATH": f"{tools}:{os.environ['PATH']}"})
    (wheel,) = (out / "wheels").glob("handscope-*.whl")
else:
    wheel = pathlib.Path(sys.argv[2]).absolute()
says = max(tuple(map(int, tag)) for tag in re.findall(r"manylinux_(\d+)_(\d+)", wheel.name))
with zipfile.ZipFile(wheel) as files_in_it:
    (program,) = (name for name in files_in_it.namelist() if name.endswith(".data/scripts/handscope"))
    needs = newest_glibc(files_in_it.read(program))
assert needs <= says, f"{wheel.name} says {says}, and its program needs {needs}"
print(wheel.name, "needs the C library", needs)
for how in ("pip", "uv"):
    fresh = out / f"fresh-{how}"
    if how == "pip":
        run(sys.executable, "-m", "venv", fresh)
        install, uninstall = [fresh / "bin/pip", "install", "-q"], [fresh / "bin/pip", "uninstall", "-q", "-y"]
    else:
        run(tools / "uv", "venv", "-q", "--python", sys.executable, fresh)
        at = ["-q", "--python", fresh / "bin/python"]
        install, uninstall = [tools / "uv", "pip", "install", *at], [tools / "uv", "pip", "uninstall", *at]
    before = files(fresh)
    run(*install, "--no-index", wheel)
    run(fresh / "bin/handscope", "--version", env=bare)
    five_lines = """
import handscope
with handscope.open("sim:") as hand, hand.armed():
    print(hand.move(index=700, speed=500), hand.state.angle)
"""
    run(fresh / "bin/python", "-c", five_lines, cwd=fresh, env=bare)
    if how == "pip":
        run(*install, "pandas", "pyarrow")
        run(fresh / "bin/python", "-m", "unittest", "discover", package / "tests", cwd=fresh, env=bare)
    run(*uninstall, "handscope")
    left = {path for path in files(fresh) - before if "handscope" in str(path.relative_to(fresh)).lower()}
    assert not left, left
print(wheel.name, "is installed by pip and uv, moves a hand, and leaves nothing behind")
