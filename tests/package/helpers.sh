#!/usr/bin/env bash
# What the tests of packages have in common; sourced.
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
test=$(basename "$0" .sh)

step() { echo "$test: $1" >&2; }
skip() {
    echo "$test: skipped: $1" >&2
    exit 77
}
fail() {
    echo "$test: error: $1" >&2
    exit 1
}

# The commands below "<!-- commands: NAME -->" of docs/install.md.
commands_of() {
    local commands
    commands=$(sed -n "/^<!-- commands: $1 -->\$/,/^\`\`\`\$/p" "$source/docs/install.md" | sed -e '1,2d' -e '$d')
    [[ -n $commands ]] || fail "docs/install.md has no commands: $1"
    printf 'set -e\n%s\n' "$commands"
}

# has_answer TEXT FOLDER: the command of an answer printed it and wrote its page.
has_answer() {
    [[ $1 == *$'\nTime '* ]] || fail "no answer: $1"
    [[ -s $2/flightwatt-out/answer.html ]] || fail "the answer has no page"
}
