cargo fmt --all --check
CLIPPY_CONF_DIR=.ci cargo clippy --all-targets --locked -- -D warnings
