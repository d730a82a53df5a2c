# The step that wants one says if it cannot be had.
for group in "$window" "$checkers" "$modbus"; do apt_install "$group" || true; done
for group in "$can_python" "$modbus_python" "$more_modbus_python" "$models" "$readers" "$tools" datasets rerun-sdk; do
  pip_install "$group" || true
done
# Unitree's stack is tried by the tests.
if [ -x "$out/dds/bin/pip" ]; then
  "$out/dds/bin/pip" install -q cyclonedds==0.10.2 || rm -r "$out/dds"
fi
