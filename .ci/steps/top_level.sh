strangers=$(git ls-files | cut -d/ -f1 | sort -u | grep -vxE '\.ci|\.gitignore|Cargo\.(toml|lock)|LICENSE-(APACHE|MIT)|README\.md|assets|screenshots|src|tests' || true)
[ -z "$strangers" ] || { echo "does not belong at the top level: $strangers"; exit 1; }
