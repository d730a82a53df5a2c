"$handscope" model --urdf --mjcf --out "$out/model"
if pip_install "$models"; then
  python tests/interop/model.py "$out/model" tests/geometry/forward-kinematics.csv
else
  skipped mujoco "not here and not to be had"
fi
