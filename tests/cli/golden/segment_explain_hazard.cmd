flightwatt segment "$SOURCE/logs/hazards/hazard_01_two-sorties.data" --explain
