// The page of one answer: reads the embedded documents and fills the sections that they have numbers for.

import { section } from './dom.js';
import { groundOf } from './ground.js';
import { hopPanel } from './hop.js';
import { hasSigmas, marginsFigure } from './margins.js';
import { embedded, Mission } from './mission.js';
import { planFigure } from './plan.js';
import { profileFigure } from './profile.js';
import { provenanceSection } from './provenance.js';
import { Selection } from './selection.js';
import { spaceFigure } from './space.js';
import { legsTable } from './table.js';
import { tradeSection } from './trade.js';
import { alternativesSection, sensitivitySection, trialsSection } from './trials.js';
import { header } from './verdict.js';

const mission = new Mission(embedded());
const ground = groundOf(mission);
const selection = new Selection(mission);
const hasLegs = mission.legs.length > 0;
const hasProfile = hasLegs || (mission.ground.pieces ?? []).length > 0;

document.title = mission.title;
header(mission);
if (hasProfile) profileFigure(section('profile', 'Profile and feasible take-off angles'), mission, selection);
if (mission.isOnMap) planFigure(section('plan', 'From above'), mission, ground, selection);
if (ground.posts || ground.facets) spaceFigure(section('space', 'In three dimensions'), mission, ground, selection);
if (hasLegs) hopPanel(section('selected', 'Selected leg'), mission, selection);
if (hasLegs) legsTable(section('legs', 'All legs'), mission, selection);
if (hasSigmas(mission)) marginsFigure(section('margins', 'Margins against the errors'), mission, selection);
if (mission.trials) trialsSection(section('trials', 'Trials'), mission);
if (mission.sensitivity) sensitivitySection(section('sensitivity', 'What each error costs'), mission);
if (mission.value.alternatives?.length > 0) alternativesSection(section('alternatives', 'Alternatives'), mission);
if (mission.trade) tradeSection(section('trade', 'What if'), mission);
provenanceSection(section('provenance', 'Provenance'), mission);
document.documentElement.dataset.ready = 'yes';
