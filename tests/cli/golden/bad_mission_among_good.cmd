sed -e "s,\.\./\.\.,$SOURCE," -e 's,fps = 32,fps = 99,' "$SOURCE/missions/paper/phased.toml" > mission.toml
flightwatt compare "$SOURCE/missions/paper/adaptive.toml" mission.toml -o result.csv; code=$?; ls; exit $code
