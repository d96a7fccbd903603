flightwatt plan "$SOURCE/missions/paper/plan.toml" --json > plan.json || exit
flightwatt simulate "$SOURCE/missions/paper/adaptive.toml" --json -o curve.csv > adaptive.json || exit
python3 -c 'import json
plan = json.load(open("plan.json")); adaptive = json.load(open("adaptive.json"))
print(list(plan)); print(plan["feasible"], *(round(plan[key], 4) for key in ["utility", "bound", "final_soc_percent", "reserve_soc_percent"]))
print("as much as adaptive:", plan["utility"] >= adaptive["utility"] - 1e-12, "gap in percent below 0.1:", plan["bound"] <= plan["utility"] * 1.001)
print("reserve kept:", plan["final_soc_percent"] >= plan["reserve_soc_percent"])'
