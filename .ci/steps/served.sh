sim_start 2 --rs485 "$out/hand" --tcp 127.0.0.1:0
tcp=$(awk '/^ready tcp/ {print $3}' "$out/ready.txt")
"$handscope" watch --hand "rs485:$out/hand" --for 2 --json | tail -n 1
"$handscope" watch --hand "tcp:$tcp" --for 2 --json | tail -n 1
"$handscope" read ANGLE_ACT HAND_ID --hand "tcp:$tcp"
sim_end
