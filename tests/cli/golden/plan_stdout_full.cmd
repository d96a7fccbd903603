flightwatt plan "$SOURCE/missions/paper/plan.toml" 2> diagnostics > /dev/full; code=$?; tail -n 1 diagnostics >&2; exit $code
