measure() {
  rm -rf "$out/trials"
  "$handscope" trial --hand 'sim:?scenario=rigid' --joint index --start 600 --close 300 --speed 25,250 --force 250,500 \
    --dwell 0.5 --ceiling 4000 --arm --out "$out/trials"
}
if pip_install pandas; then
  unless_busy measure
  python tests/interop/pandas_trials.py "$out/trials"
else
  skipped pandas "not here and not to be had"
fi
