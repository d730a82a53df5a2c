"""The wheel as a stranger gets it: built by maturin, installed by pip and by uv where nothing else is, tried, and removed.
Usage: python_wheel.py FOLDER, by a Python beside which maturin and uv are."""
import os
import pathlib
import subprocess
import sys

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


build = [tools / "maturin", "build", "--profile", "dev", "--locked", "--out", out / "wheels"]
run(*build, cwd=package, env=os.environ | {"PATH": f"{tools}:{os.environ['PATH']}"})
(wheel,) = (out / "wheels").glob("handscope-*.whl")
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
        run(*install, "pandas")
        run(fresh / "bin/python", "-m", "unittest", "discover", package / "tests", cwd=fresh, env=bare)
    run(*uninstall, "handscope")
    left = {path for path in files(fresh) - before if "handscope" in str(path.relative_to(fresh)).lower()}
    assert not left, left
print(wheel.name, "is installed by pip and uv, moves a hand, and leaves nothing behind")
