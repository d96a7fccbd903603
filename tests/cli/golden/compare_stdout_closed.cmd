flightwatt compare "$SOURCE/missions/paper/phased.toml" 2> diagnostics >&-; code=$?; tail -n 1 diagnostics >&2; exit $code
