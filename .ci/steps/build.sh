# What was built: others cannot ask cargo while it lints.
cargo test --locked --no-run 2>&1 | tee "$out/built.txt"
