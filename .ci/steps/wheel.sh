if pip_install "$tools"; then
  python -m mypy --strict --cache-dir=/dev/null assets/python/handscope
  python tests/interop/python_wheel.py "$out"
  PYTHONPATH=assets/python PATH="$out/python/bin:$PATH" python assets/python/tests/notebook.py
else
  skipped maturin "not here and not to be had"
fi
# LeRobot is three gigabytes, so only where it is already.
if [ -n "${HANDSCOPE_LEROBOT_PYTHON:-}" ]; then
  "$HANDSCOPE_LEROBOT_PYTHON" -m pip install -q --no-deps --target "$out/plugins" \
    assets/python/lerobot/robot assets/python/lerobot/teleoperator
  PYTHONPATH="assets/python:$out/plugins" HF_HUB_OFFLINE=1 HF_HOME="$out/hf" \
    "$HANDSCOPE_LEROBOT_PYTHON" assets/python/tests/lerobot_plugins.py "$out"
else
  skipped lerobot "no Python that has it is named by HANDSCOPE_LEROBOT_PYTHON"
fi
