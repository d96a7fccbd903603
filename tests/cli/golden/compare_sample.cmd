flightwatt compare "$SOURCE"/missions/paper/*.toml
