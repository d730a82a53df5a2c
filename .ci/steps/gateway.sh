# As a client, pymodbus is tried by the tests, which find it on the path.
if ! pip_install "$modbus_python"; then
  skipped pymodbus "not here and not to be had"
  exit
fi
unless_busy python tests/interop/pymodbus_server.py "$handscope" "$out"
PATH="$out/python/bin:$PATH"
pip_install "$more_modbus_python" || true
apt_install "$modbus" || true
unless_busy python tests/interop/gateway_clients.py "$handscope"
