[ ! -x "$out/dds/bin/python" ] || export HANDSCOPE_DDS_PYTHON=$out/dds/bin/python
PATH="$out/python/bin:$PATH"
HANDSCOPE_SOAK=1 cargo test --locked --no-fail-fast
