for turn in 1 2; do
  .ci/gallery "$out/gallery$turn" >"$out/files$turn.txt"
done
diff -r "$out/gallery1" "$out/gallery2"
echo "the gallery is the same twice: $(ls "$out/gallery1" | wc -l) files"
