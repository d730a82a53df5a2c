[ ! -x "$out/dds/bin/python" ] || export HANDSCOPE_DDS_PYTHON=$out/dds/bin/python
PATH="$out/python/bin:$PATH"
# Half of them wait for processes and wires.
export RUST_TEST_THREADS=$((2 * $(nproc)))
HANDSCOPE_SOAK=1 cargo test --locked --no-fail-fast
