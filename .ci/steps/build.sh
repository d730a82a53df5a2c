# Written down for steps that run while the lints hold the lock of cargo.
cargo test --locked --no-run 2>&1 | tee "$out/built.txt"
