# Days of virtual time and millions of inputs. The modules of the tests that count, by their files.
mapfile -t modules < <(grep -rlE 'soak::(times|is_full)' src tests/it --include=*.rs | grep -v setup/soak |
  sed -E 's!^(src|tests/it)/!!; s!\.rs$!!; s!/mod$!!; s!/!::!g; s!$!::!')
printf '%s\n' "${modules[@]}"
HANDSCOPE_SOAK=1 cargo test --locked --no-fail-fast --lib --test it -- "${modules[@]}"
