sed -e "s,\.\./\.\.,$SOURCE," -e 's,fps = 32,fps = 99,' "$SOURCE/missions/paper/phased.toml" > mission.toml
flightwatt simulate mission.toml -o result.csv; code=$?; ls; exit $code
