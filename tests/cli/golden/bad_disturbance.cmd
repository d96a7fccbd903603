printf '[[disturbance]]\nphase = "cruise"\nfrom = 900\nmechanical_factor = 1.1\n' > d.toml
flightwatt simulate "$SOURCE/missions/paper/phased.toml" --disturb d.toml
