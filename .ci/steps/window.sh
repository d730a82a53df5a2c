if ! { command -v Xvfb && command -v xdotool; } >/dev/null && ! apt_install "$window"; then
  skipped "the real window" "no Xvfb here and none to be had"
  exit
fi
Xvfb :77 -noreset -screen 0 1440x900x24 >"$out/xvfb.txt" 2>&1 &
xvfb=$!
sleep 2
status=0
HOME="$out" XDG_CONFIG_HOME="$out" DISPLAY=:77 timeout 6 "$handscope" --hand sim: 2>"$out/window.txt" || status=$?
kill "$xvfb"
# 124: it was still open when the time was over, as it should be.
[ "$status" -eq 124 ] || { cat "$out/window.txt"; exit 1; }
echo "the window opened and stayed open"
