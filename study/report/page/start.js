// What the page consists of: a section without data does not appear.

const bowstringReport = { report, view, figures, sections, drawAll: () => sections.forEach(drawSection) };
window.bowstringReport = bowstringReport;

drawHeader();
drawHeadlines();
if (quantities.length) view.quantity = Math.max(range(quantities.length).findIndex(hasValues), 0);
watchers.push(buildControls(), buildMainFigure());

const someValue = range(quantities.length).some(hasValues);
if (report.along !== null && someValue) addSection("convergence", "Convergence", buildConvergence);
if (mappableAxes.length >= 2 && !baseline) addSection("heat-map", "Two axes at once", buildHeatMap);
if (report.effects.length) addSection("effects", "Effects", buildEffects);
if (report.distributions.length || (sampledAxes.length && someValue))
  addSection("distribution", "Distribution", buildDistribution);
if (report.sensitivities.length || report.inseparable.length)
  addSection("sensitivities", "Sensitivities", buildSensitivities);
if (report.energies.some(({ values }) => values.some(isKnown))) addSection("energies", "Energy", buildEnergies);
if (report.shapes.length) addSection("shapes", "Shapes", buildShapes);
if (failedRuns.length) addSection("failures", "Failures", buildFailures);
addSection("runs", "Runs", buildRunsTable);

const schemeButton = document.getElementById("scheme");
schemeButton.addEventListener("click", () => {
  setScheme(schemes[(schemes.indexOf(scheme) + 1) % schemes.length]);
  schemeButton.textContent = `Scheme: ${scheme}`;
});
addEventListener("beforeprint", bowstringReport.drawAll);

changed();
bowstringReport.readyAfter = performance.now(); // ms since the page was asked for
document.documentElement.dataset.ready = "true";
