sed -e "s,\.\./\.\.,$SOURCE," -e 's,opterra-table1,nothing,' "$SOURCE/missions/paper/phased.toml" > mission.toml
flightwatt simulate mission.toml -o result.csv; code=$?; ls; exit $code
