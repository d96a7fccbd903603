cd "$SOURCE" && flightwatt compare missions/paper/adaptive*.toml missions/paper/p*.toml missions/paper/inv*.toml --disturb missions/disturbances/headwind.toml
