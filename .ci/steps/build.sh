cargo test --locked --no-run
