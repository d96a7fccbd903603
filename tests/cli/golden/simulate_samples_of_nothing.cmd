cd "$SOURCE" && flightwatt simulate missions/paper/computing-only.toml --samples 10
