// What the answers rest on, folded: models, checks, the battery, the software, all numbers of the missions, and notes.
import type { ReportDocument } from "../documents";
import { Opened } from "../ui/opened";
import { BatteryPart } from "./battery";
import { ModelPart, PhysicalPart, ValidationPart } from "./models";
import { Schedules } from "./schedules";
import { Profiles } from "./software";
import { plural } from "./words";

/// Whether a document has any of these parts.
export const hasCertainty = (of: ReportDocument) =>
  of.models.length > 0 || of.physical != null || of.validation != null || of.battery != null || of.software.length > 0 || of.missions.length > 0 || of.warnings.length + of.notes.length > 0;

export function Certainty({ of }: { of: ReportDocument }) {
  const { models, physical, validation, battery, software, missions, schedules, warnings, notes } = of;
  return (
    <div class="card certainty">
      {validation && <Opened title="How well flights are predicted" aside={validation.warning && "SYNTHETIC flights"}>{() => <ValidationPart validation={validation} />}</Opened>}
      {models.map((model) => <Opened title={`${model.is_of_missions ? "Missions' model" : "Model"} of power: ${model.name}`}>{() => <ModelPart model={model} />}</Opened>)}
      {physical && <Opened title="Power from airspeed and climb">{() => <PhysicalPart physical={physical} />}</Opened>}
      {battery && <Opened title="Battery" id="battery" aside={battery.warnings.length > 0 && plural(battery.warnings.length, "warning")}>{() => <BatteryPart battery={battery} />}</Opened>}
      {software.length > 0 && <Opened title="Power of the software">{() => <Profiles software={software} />}</Opened>}
      {missions.length > 0 && <Opened title="All numbers of the missions, and what differs between drawn flights">{() => <Schedules missions={missions} notes={schedules} />}</Opened>}
      {warnings.length + notes.length > 0 && (
        <Opened title="Notes on models and contents" id="notes" aside={plural(warnings.length + notes.length, "note")}>
          {() => (
            <ul>
              {warnings.map((text) => <li><b>Warning:</b> {text}</li>)}
              {notes.map((text) => <li>{text}</li>)}
            </ul>
          )}
        </Opened>
      )}
    </div>
  );
}
