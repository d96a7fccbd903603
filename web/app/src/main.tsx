// The front end: a report with its data inside, or with the engine a page that reads logs.
import { render } from "preact";
import "./app.css";
import { carriedDocument } from "./documents";
import { hasEngine, openEngine } from "./engine/open";
import { EngineApp } from "./screens/engine_app";
import { Report } from "./screens/report";
import { Project } from "./work/project";

const place = document.getElementById("app");
const carried = carriedDocument();
if (place && carried) {
  place.replaceChildren();
  render(<Report document={carried} />, place);
} else if (place && hasEngine()) {
  const project = new Project(openEngine());
  place.replaceChildren();
  render(<EngineApp project={project} />, place);
  void project.start();
}
