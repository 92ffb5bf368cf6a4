// How the devices are, how they were while this page was open, and which objective is in place.
import { html } from "../../../lib/html.ts";
import { AccuracyPlot } from "./accuracy_plot.ts";
import { DeviceHealth } from "./device_health.ts";
import { MetricSparklines } from "./metric_sparklines.ts";
import { ObjectiveChoice } from "./objective_choice.ts";

export function DevicesView() {
  return html`<div class="pairs"><${DeviceHealth}/><${MetricSparklines}/><${AccuracyPlot}/><${ObjectiveChoice}/></div>`;
}
