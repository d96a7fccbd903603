sed -e "s,\.\./\.\.,$SOURCE," -e 's,^battery.*,battery = { voltage_v = -1 \, resistance_ohm = 0\, capacity_ah = 1 },' "$SOURCE/missions/paper/phased.toml" > mission.toml
flightwatt simulate mission.toml -o result.csv; code=$?; ls; exit $code
