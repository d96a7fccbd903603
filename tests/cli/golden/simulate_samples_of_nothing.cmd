cd "$SOURCE" && flightwatt simulate missions/paper/phased.toml --samples 10
