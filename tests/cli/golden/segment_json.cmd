flightwatt segment "$SOURCE/logs/opterra_synthetic_01.data" --json > flight.json || exit
python3 - <<'END'
import json
flight = json.load(open("flight.json"))
print(list(flight), flight["flight"], flight["aircraft_id"], flight["power_source"])
for sortie in flight["sorties"]:
    for phase in sortie["phases"]:
        print(list(phase))
        print(phase["phase"], phase["samples"], *(round(phase[key], 3) for key in (
            "start_s", "end_s", "duration_s", "mean_power_w", "energy_wh")))
END
