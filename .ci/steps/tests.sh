[ ! -x "$out/dds/bin/python" ] || export HANDSCOPE_DDS_PYTHON=$out/dds/bin/python
PATH="$out/python/bin:$PATH"
failed=
# Those that only count, in full and alone: they would take the processors from those that wait for a hand.
counting=$(grep -rl 'soak::' src tests/it --include='*.rs' |
  sed 's#^src/##; s#^tests/it/##; s#\.rs$##; s#/mod$##; s#_tests$##; s#/#::#g' | sort)
all=$(cargo test --locked -- --list 2>/dev/null)
for module in $counting; do
  grep -q "^$module" <<<"$all" || { echo "no test is in $module, whose file counts"; exit 1; }
done
HANDSCOPE_SOAK=1 cargo test --locked --no-fail-fast --lib --tests -- $counting || failed=1
# All, by the command of the README.
readme=$(sed -n 's/^\(cargo test .*[^ ]\) *#.*/\1/p' README.md)
[ -n "$readme" ] || { echo "README.md names no cargo test"; exit 1; }
${readme/ -- / --locked --no-fail-fast -- } || failed=1
[ -z "$failed" ]
