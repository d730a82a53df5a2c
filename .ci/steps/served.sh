sim_start 2 --rs485 "$out/hand" --tcp 127.0.0.1:0
tcp=$(awk '/^ready tcp/ {print $3}' "$out/ready.txt")
for hand in "rs485:$out/hand" "tcp:$tcp"; do
  unless_busy "$handscope" watch --hand "$hand" --for 2 --json >"$out/watched.txt"
  tail -n 1 "$out/watched.txt"
done
unless_busy "$handscope" read ANGLE_ACT HAND_ID --hand "tcp:$tcp"
sim_end
