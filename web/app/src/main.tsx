// The front end: a report with its data inside, or with the engine a page that reads logs.
import { render } from "preact";
import "./app.css";
import { carriedDocument } from "./documents";
import { hasEngine, openEngine } from "./engine/open";
import { EngineApp } from "./screens/engine_app";
import { Shell } from "./ui/shell";
import { Project } from "./work/project";

const place = document.getElementById("app");
const carried = carriedDocument();
if (place && !carried && hasEngine()) {
  const project = new Project(openEngine());
  place.replaceChildren();
  render(<EngineApp project={project} />, place);
  void project.start();
} else if (place) {
  place.replaceChildren();
  render(
    <Shell screens={[{ id: "report", name: "Report", show: () => <h1>{carried?.title ?? "FlightWatt"}</h1> }]} />,
    place,
  );
}
