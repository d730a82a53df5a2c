# Old pictures once made up nine tenths of it. What tests draw is compared, not committed. Source is not counted.
bytes=$(git ls-files -z -- ':!*.rs' | xargs -0 cat | wc -c)
echo "$bytes bytes in files that are not source"
[ "$bytes" -le 3000000 ] || { echo "more than 3 MB are too much: commit fewer or smaller files"; exit 1; }
