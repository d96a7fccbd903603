flightwatt fit "$SOURCE"/logs/opterra_synthetic_0?.data -o model.toml --json > model.json || exit
python3 - <<'END'
import json
model = json.load(open("model.json"))
print(list(model))
for name, phase in model["phases"].items():
    print(name, list(phase), len(phase["cos_w"]), len(phase["sin_w"]), phase["samples"], phase["flights"])
    print(round(phase["duration_s"], 1), round(phase["a0_w"], 1))
for flight in model["flights"]:
    print(flight["flight"], {name: round(weight, 2) for name, weight in flight["weights"].items()})
END
