if pip_install datasets; then
  # Two recordings make one set. The scenario moves by itself, so nothing commands it.
  "$handscope" export "$session/session.mcap" --mcap --from -3 --out "$session/end.mcap"
  "$handscope" export "$session/session.mcap" "$session/end.mcap" --lerobot --uncommanded --task grasp --out "$session/set"
  HF_HUB_OFFLINE=1 HF_HOME="$out/hf" python tests/interop/lerobot.py "$session"
else
  skipped datasets "not here and not to be had"
fi
if pip_install rerun-sdk; then
  # It would tell its makers that it was used.
  HOME="$out" "$out/python/bin/rerun" analytics disable >"$out/rerun.txt" 2>&1
  for file in "$session/session.mcap" "$session"/bag/*.mcap; do
    HOME="$out" "$out/python/bin/rerun" mcap check --full "$file" | tee "$out/rerun.txt"
    awk '/^─/ {rows = 1; next} rows && NF && $1 != "ok" {bad = 1} END {exit bad || !rows}' "$out/rerun.txt"
  done
else
  skipped rerun "not here and not to be had"
fi
