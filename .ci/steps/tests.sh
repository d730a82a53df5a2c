[ ! -x "$out/dds/bin/python" ] || export HANDSCOPE_DDS_PYTHON=$out/dds/bin/python
PATH="$out/python/bin:$PATH"
# Half of the time they wait for processes, signals and wires.
export RUST_TEST_THREADS=$(($(nproc) * 3 / 2))
HANDSCOPE_SOAK=1 cargo test --locked --no-fail-fast
