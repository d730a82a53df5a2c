[ ! -x "$out/dds/bin/python" ] || export HANDSCOPE_DDS_PYTHON=$out/dds/bin/python
PATH="$out/python/bin:$PATH"
cargo test --locked --no-fail-fast
