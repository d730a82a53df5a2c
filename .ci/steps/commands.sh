"$handscope" --help >"$out/help.txt"
"$handscope" help wiring >"$out/wiring.txt"
"$handscope" registers >"$out/registers.txt"
"$handscope" registers --json >"$out/registers.json"
"$handscope" read ANGLE_ACT TEMP --hand sim:
"$handscope" watch --hand sim: --for 1
