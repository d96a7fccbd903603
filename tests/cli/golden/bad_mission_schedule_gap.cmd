sed -e "s,\.\./\.\.,$SOURCE," -e 's,^otherwise.*,phase = "cruise"\nto = 200,' "$SOURCE/missions/paper/phased.toml" > mission.toml
flightwatt simulate mission.toml -o result.csv; code=$?; ls; exit $code
