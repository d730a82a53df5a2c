{
  cat "$out/skipped.txt" 2>/dev/null || true
  grep -o 'skipped: .*' "$out/log/tests.txt" | grep -vE "^skipped: $(cat "$out/tried_in_guest" 2>/dev/null || echo nothing):" || true
} | sort -u >"$out/all_skipped.txt"
cat "$out/all_skipped.txt"
while read -r what; do
  if grep -q "^skipped: $what:" "$out/all_skipped.txt"; then
    echo "$what can be had on this machine and must not be skipped"
    exit 1
  fi
done <"$out/required.txt"
echo "$(wc -l <"$out/all_skipped.txt") skipped"
awk '/^test result:/ {passed += $4; failed += $6} END {print passed " passed, " failed " failed"}' "$out/log/tests.txt"
