sed -e "s,\.\./\.\.,$SOURCE," -e 's,^battery,batery,' "$SOURCE/missions/paper/phased.toml" > mission.toml
flightwatt simulate mission.toml -o result.csv; code=$?; ls; exit $code
