if env -u DISPLAY -u WAYLAND_DISPLAY "$handscope" --hand sim: 2>"$out/no-display.txt"; then
  echo "it opened a window without a display"
  exit 1
fi
grep snapshot "$out/no-display.txt"
