flightwatt plan "$SOURCE/missions/paper/plan.toml" --probability 0.95
