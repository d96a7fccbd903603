cp -r "$SOURCE/fits" "$SOURCE/missions" .
flightwatt compare missions/paper/adaptive-replanned.toml missions/paper/phased.toml missions/paper/computing-only.toml --samples 200 --seed 1
