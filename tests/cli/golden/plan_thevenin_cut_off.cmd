# Even the schedule that drains least is cut off.
sed "s#cutoff_voltage_v = 10.5#cutoff_voltage_v = 11.1#; s#\.\./\.\./fits#$SOURCE/fits#" "$SOURCE/missions/synthetic/thevenin-plan.toml" > mission.toml
flightwatt plan mission.toml --largest-payload
flightwatt plan mission.toml -o plan.toml; code=$?; ls; exit $code
