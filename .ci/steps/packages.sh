if command -v dpkg-deb >/dev/null && apt_install "$checkers"; then
  for turn in 1 2; do .ci/package --dev "$out/packages$turn"; done
  diff -r "$out/packages1" "$out/packages2"
  sh tests/interop/deb.sh "$out"/packages1/handscope_*.deb
else
  skipped lintian "not here and not to be had"
fi
