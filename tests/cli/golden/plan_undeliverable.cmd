cp -r "$SOURCE/fits" "$SOURCE/missions" .
sed -i 's/^battery = .*/battery = { voltage_v = 11.1, resistance_ohm = 0.5, capacity_ah = 3.2 }/' missions/paper/plan.toml
flightwatt plan missions/paper/plan.toml
