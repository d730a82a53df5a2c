rm -rf "$session"
mkdir "$session"
"$handscope" record --hand 'sim:?scenario=grasp' --for 6 --out "$session/session.mcap"
"$handscope" info "$session/session.mcap"
for form in csv parquet; do
  "$handscope" export "$session/session.mcap" "--$form" --out "$session/session.$form"
done
"$handscope" export "$session/session.mcap" --rosbag --out "$session/bag"
if ! pip_install "$readers"; then
  skipped mcap "not here and not to be had"
  skipped polars "not here and not to be had"
  exit
fi
python tests/interop/sessions.py "$session"
"$handscope" ros2 --out "$session/hand_ws"
python tests/interop/ros2_workspace.py "$session/hand_ws" "$session/bag"
# What pandas and polars made of our values is imported, and says the same.
for library in pandas polars; do
  "$handscope" import "$session/$library.csv"
  "$handscope" export - --csv --out - <"$session/$library.mcap" >"$session/$library-again.csv"
done
cmp "$session/pandas-again.csv" "$session/polars-again.csv"
python tests/interop/same_values.py "$session/session.csv" "$session/pandas-again.csv"
python tests/interop/rewritten.py "$handscope" "$session"
